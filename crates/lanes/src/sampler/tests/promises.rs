//! What a seed gives.

use super::*;

/// A seed promises its numbers: whoever changes these lines changes every published result. That
/// the numbers are right is for the other tests to say.
#[test]
fn first_draws_never_change() {
    let promised = [
        (
            Sampler::Normal { mean: 0.0, sd: 1.0 },
            -1.8343497730272897,
            -1.7960520041924075,
        ),
        (
            Sampler::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 4.0,
            },
            -2.9371290404509893,
            1.7640046403169067,
        ),
        (
            Sampler::Uniform {
                lower: 0.0,
                upper: 1.0,
            },
            0.08328046212704465,
            0.839615476204657,
        ),
        (
            Sampler::Triangular {
                lower: 0.0,
                mode: 0.25,
                upper: 1.0,
            },
            0.14429177222475692,
            0.6531738290634524,
        ),
        (
            Sampler::Trapezoidal {
                lower: 0.0,
                upper: 1.0,
                beta: 0.5,
            },
            0.09123504044257524,
            0.3113851269911634,
        ),
        (
            Sampler::CurvilinearTrapezoid {
                lower: 0.0,
                upper: 1.0,
                d: 0.125,
            },
            0.03490084516588652,
            0.8016242005807402,
        ),
        (
            Sampler::Arcsine {
                lower: -1.0,
                upper: 1.0,
            },
            -0.9659688027542226,
            0.8757240740949213,
        ),
        (
            Sampler::Exponential {
                origin: 0.0,
                mean: 1.0,
            },
            2.4855413056148765,
            0.17481125837484024,
        ),
        (
            Sampler::Gamma {
                origin: 0.0,
                shape: 0.5,
                scale: 1.0,
            },
            0.014493026346368667,
            0.1486530194512111,
        ),
        (
            Sampler::Gamma {
                origin: 0.0,
                shape: 2.5,
                scale: 1.0,
            },
            0.43288451147025475,
            0.813852881408486,
        ),
        (
            Sampler::LogNormal {
                origin: 0.0,
                mu: 0.0,
                sigma: 0.5,
            },
            0.39964649444402156,
            0.40737302005159015,
        ),
        (
            Sampler::Beta {
                alpha: 0.5,
                beta: 2.0,
                lower: 0.0,
                upper: 1.0,
            },
            0.014066309189337472,
            0.0515891223517291,
        ),
        (
            Sampler::discrete(&[1.0, 2.0, 3.0], &[0.2, 0.5, 0.3]),
            1.0,
            3.0,
        ),
        (
            Sampler::Empirical {
                sample: Arc::new([1.0, 5.0, 7.0, 8.0]),
            },
            1.0,
            8.0,
        ),
    ];
    for (sampler, first, last) in promised {
        let mut block = Block::ZERO;
        sampler.fill(level(), &mut Generator::new(1, 0, 0), &mut block);
        let found = [block.0[0], block.0[LANES - 1]];
        assert_eq!(found, [first, last], "{sampler:?}");
    }
}
