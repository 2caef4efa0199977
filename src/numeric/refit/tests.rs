use super::*;

#[test]
fn an_end_goes_as_far_as_the_samples_do() {
    let path = kurbo::BezPath::from_svg("M0 0L5 0").unwrap();
    let mut chain = Chain::from_path(&path, 0.001).unwrap();
    for node in &mut chain.nodes {
        node.join = Join::Loose;
    }
    let samples: Vec<Sample> = (0..=20)
        .map(|i| Sample {
            at: Point::new(0.5 * f64::from(i), 0.0),
            weight: 1.0,
            sigma: 0.1,
        })
        .collect();
    let mut feet = vec![Foot { segment: 0, t: 0.5 }; samples.len()];
    let scale = Scale {
        sigma: 0.1,
        robust: 4.0,
        freedom: 10.0,
    };
    let stop = Stop {
        rounds: 60,
        gain: 1e-6,
        enough: f64::INFINITY,
    };
    let cost = Refit::default().run(&mut chain, (&samples, &mut feet), scale, stop);
    assert!(chain.nodes[1].point.x > 9.0, "{:?}", chain.nodes[1].point);
    assert!(cost < 20.0, "{cost}");
}
