//! Kernels in f32 against the same in f64: no more than their stated error.

use smalti_core::bsdf::fresnel::{boundary, reflectance};
use smalti_core::lanes::One;
use smalti_core::lanes::math::{exp_minus, leading_bits};
use smalti_core::settings::Fresnel;
use smalti_tests::accuracy::{KERNELS, Kernel, Worst};
use smalti_tests::oracle::Random;

/// Beer and Lambert: nothing is left of light behind more than can be told from nothing, and all of it behind nothing.
#[test]
fn transmittance_ends_at_none_and_at_all() {
    let of = |absorption: f64, distance: f32| {
        let leading = leading_bits(absorption as f32);
        exp_minus(One, (leading, (absorption - f64::from(leading)) as f32), distance)
    };
    for absorption in [1.0, 0.3, 1.7e-3, 12.345_678_9, 3.3e4] {
        assert_eq!(of(absorption, (1e4 / absorption) as f32), 0.0);
        assert_eq!(of(absorption, f32::MAX), 0.0);
        assert_eq!(of(absorption, 0.0), 1.0);
    }
    assert_eq!(of(0.0, f32::MAX), 1.0);
    assert_eq!(of(f32::MAX.into(), f32::MAX), 0.0);
}

fn kernel(ior: f64, outside: bool, cosine: f32) -> f64 {
    let constants = [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32];
    f64::from(reflectance(One, Fresnel::Exact, &boundary(One, constants, outside, cosine)))
}

/// The table of docs/kernels.md, with fewer arguments.
#[test]
fn every_kernel_keeps_its_bound() {
    for Kernel { name, bound, worst, .. } in KERNELS {
        let Worst { error, at } = worst(&mut Random::new(20), 200_000);
        assert!(error <= *bound, "{name}: off by {error:e} at {at:?}");
    }
}

#[test]
fn reflectance_is_a_fraction_and_the_same_from_both_sides() {
    let mut random = Random::new(21);
    for _ in 0..1_000_000 {
        let ior = libm::exp2(random.between(-3.0, 7.0));
        // Grazing more than others, and exactly.
        let cosine = random.unit() as f32 * [1.0, 1e-3, 1e-6, 0.0][random.below(4)];
        for outside in [true, false] {
            let f = kernel(ior, outside, cosine);
            assert!((0.0..=1.0).contains(&f), "index {ior}, cosine {cosine}: {f}");
        }
        let constants = [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32];
        let into = boundary(One, constants, true, cosine);
        if cosine > 0.1 && into.cosine_refracted > 0.1 && (0.5..4.0).contains(&ior) {
            let (there, back) = (kernel(ior, true, cosine), kernel(ior, false, into.cosine_refracted));
            // The cosine on the other side is rounded, and counts n² times as much here.
            assert!(
                (there - back).abs() < 5e-6 * (ior * ior).max(1.0 / ior),
                "index {ior}, cosine {cosine}: {there} and back {back}"
            );
        }
    }
}
