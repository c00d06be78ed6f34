//! Speed of the kernels, in grain-steps a second: for each workload the reference, and the fast kernel with each set of
//! instructions that the machine has.

mod workloads;

use std::time::Duration;

use criterion::{BatchSize, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};

use workloads::{Path, Workload};

fn kernels(criterion: &mut Criterion) {
    for workload in Workload::ALL {
        let mut group = criterion.benchmark_group(workload.name());
        group
            .sample_size(10)
            .sampling_mode(SamplingMode::Flat)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(2));
        for path in Path::all() {
            if !path.instructions.available() {
                continue;
            }
            let simulation = workload
                .simulation(path)
                .expect("the grains of each workload fit and do not diverge");
            let grains = simulation.bodies().grains as u64;
            group.throughput(Throughput::Elements(grains * workload.steps()));
            group.bench_function(path.name, |bencher| {
                // Every sample starts from the same state; the copy is not timed.
                bencher.iter_batched_ref(
                    || simulation.clone(),
                    |simulation| {
                        simulation
                            .advance(workload.steps())
                            .expect("the steps are short enough");
                    },
                    BatchSize::LargeInput,
                );
            });
        }
        group.finish();
    }
}

criterion_group!(benches, kernels);
criterion_main!(benches);
