//! Compiles the known mistakes in when `SMALTI_MUTANTS` is set: for the mutation run (`just mutants`) alone.

fn main() {
    println!("cargo:rerun-if-env-changed=SMALTI_MUTANTS");
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var_os("SMALTI_MUTANTS").is_some() {
        println!("cargo:rustc-cfg=mutants");
        println!("cargo:warning=this build can make mistakes on purpose");
    }
}
