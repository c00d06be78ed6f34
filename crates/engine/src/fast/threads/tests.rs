use std::thread;
use std::time::Duration;

use rayon::prelude::*;

use super::*;

/// Each of so many stretches, three items long, writes its number on its own.
fn written(threads: &Threads, stretches: usize) -> Vec<usize> {
    let mut items = vec![usize::MAX; 3 * stretches];
    let mut numbers: Vec<usize> = (0..stretches).collect();
    threads.each(&mut numbers, &mut items[..], &|_| 3, &|number, own| {
        own.fill(*number);
    });
    items
}

/// The legs in the order in which they are done, beside so many stretches, all of which are done too.
fn in_turn<L: Copy + Send + Sync, const CHAINS: usize>(
    threads: &Threads,
    legs: [&[L]; CHAINS],
    stretch: &(dyn Fn(&L) -> usize + Sync),
    stretches: usize,
) -> Vec<L> {
    let done = Mutex::new(Vec::new());
    let chains = Chains {
        legs,
        stretch,
        work: &|leg: &L| done.lock().expect("no panic").push(*leg),
    };
    let mut numbers = vec![0; stretches];
    threads.each_beside(
        &mut numbers,
        (),
        &|_| 0,
        &|number, ()| *number += 1,
        &chains,
    );
    assert_eq!(numbers, vec![1; stretches]);
    done.into_inner().expect("no panic")
}

fn expected(stretches: usize) -> Vec<usize> {
    (0..3 * stretches).map(|item| item / 3).collect()
}

#[test]
fn every_stretch_is_done_once_by_any_number_of_threads() {
    for number in [1, 2, 3, 5] {
        let threads = Threads::new(number).expect("threads");
        assert_eq!(threads.number(), number);
        for stretches in [0, 1, 2, 7, 64] {
            threads.install(|| {
                for _ in 0..20 {
                    assert_eq!(written(&threads, stretches), expected(stretches));
                }
            });
        }
    }
}

#[test]
fn threads_that_sleep_are_waked() {
    let threads = Threads::new(3).expect("threads");
    threads.install(|| {
        for _ in 0..3 {
            assert_eq!(written(&threads, 12), expected(12));
            thread::sleep(Duration::from_millis(5));
        }
    });
}

#[test]
fn work_within_work_and_by_two_at_once_is_done_too() {
    let threads = Threads::new(2).expect("threads");
    let mut inner = [(); 6].map(|()| Vec::new());
    threads.install(|| {
        threads.each(&mut inner, (), &|_| 0, &|inner, ()| {
            *inner = written(&threads, 5);
        });
    });
    assert!(inner.iter().all(|inner| *inner == expected(5)));
    thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                threads.install(|| {
                    let legs: Vec<usize> = (0..9).collect();
                    for _ in 0..50 {
                        assert_eq!(written(&threads, 9), expected(9));
                        assert_eq!(in_turn(&threads, [&legs], &|leg| *leg, 9), legs);
                    }
                });
            });
        }
    });
}

#[test]
fn a_panic_of_any_thread_comes_to_the_caller() {
    let threads = Threads::new(3).expect("threads");
    let all_panic = || {
        threads.install(|| {
            threads.each(&mut [(); 12], (), &|()| 0, &|(), ()| {
                thread::sleep(Duration::from_millis(1));
                panic!("as it should");
            });
        });
    };
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(all_panic)).is_err());
    // They serve on.
    assert_eq!(threads.install(|| written(&threads, 12)), expected(12));
}

#[test]
fn legs_are_done_in_turn_whoever_comes() {
    for number in [1, 2, 3, 5] {
        let threads = Threads::new(number).expect("threads");
        // Stretches that belong to one thread after the other, forth and back, or all to the first.
        for stretch in [|leg: usize| leg, |leg| 7 - leg % 8, |_| 0] {
            for legs in [0, 1, 2, 23] {
                // The second chain is half as long.
                let chains = [(0, legs), (1, legs / 2)];
                let chains = chains
                    .map(|(chain, legs)| -> Vec<_> { (0..legs).map(|leg| (chain, leg)).collect() });
                let done = threads.install(|| {
                    let chains = chains.each_ref().map(Vec::as_slice);
                    in_turn(&threads, chains, &|leg| stretch(leg.1), 23)
                });
                for (number, chain) in chains.iter().enumerate() {
                    let of_chain = done.iter().copied().filter(|leg| leg.0 == number);
                    assert_eq!(of_chain.collect::<Vec<_>>(), *chain);
                }
            }
        }
    }
}

#[test]
fn short_advances_with_work_of_rayon_within_such_work_end() {
    for number in [2, 3, 5] {
        let threads = Threads::new(number).expect("threads");
        for _ in 0..5_000 {
            let sum = threads.install(|| {
                let of_one = |item: usize| {
                    let parts = (0..8).into_par_iter().with_max_len(1);
                    parts.map(|part| item + part).sum::<usize>()
                };
                let items = (0..16).into_par_iter().with_max_len(1);
                items.map(of_one).sum::<usize>()
            });
            assert_eq!(sum, 1408);
        }
    }
}
