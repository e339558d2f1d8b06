//! Compiles one known mistake in when `SMALTI_MUTANT` names it: for the mutation run (`just mutants`) alone.

fn main() {
    println!("cargo:rerun-if-env-changed=SMALTI_MUTANT");
    println!("cargo:rerun-if-changed=build.rs");
    if let Ok(name) = std::env::var("SMALTI_MUTANT") {
        println!("cargo:rustc-cfg=mutant=\"{name}\"");
        println!("cargo:warning=this build contains the mistake {name} on purpose");
    }
}
