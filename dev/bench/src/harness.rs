//! Taking times so that they can be compared.

use crate::clock::{children_seconds, cpu_seconds};
use anyhow::Result;
use std::hint::black_box;
use std::time::Instant;

/// A sample lasts at least this long, in seconds: short work is repeated, and the clock's own cost disappears.
const SHORTEST_SAMPLE: f64 = 5e-3;

/// Median seconds of both sides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Duel {
    pub(crate) ours: f64,
    pub(crate) peer: f64,
}

/// Runs both sides in turns, `rounds` times each after a warm-up, and changes who begins from round to round.
///
/// What a side returns is dropped after the clock has stopped, unless the work is so short that it is repeated.
pub(crate) fn duel<A, B>(
    rounds: usize,
    ours: impl FnMut() -> Result<A>,
    peer: impl FnMut() -> Result<B>,
) -> Result<Duel> {
    duel_by(rounds, ours, peer, cpu_seconds)
}

/// As [`duel`], where the peer runs other programs: their time counts.
pub(crate) fn duel_with_program<A, B>(
    rounds: usize,
    ours: impl FnMut() -> Result<A>,
    peer: impl FnMut() -> Result<B>,
) -> Result<Duel> {
    duel_by(rounds, ours, peer, children_seconds)
}

/// Any number of sides in turns, each of which takes its own time: `seconds(side)`. Medians, after a warm-up.
///
/// Who begins moves on from round to round.
pub(crate) fn turns(rounds: usize, sides: usize, mut seconds: impl FnMut(usize) -> Result<f64>) -> Result<Vec<f64>> {
    for side in 0..sides {
        seconds(side)?;
    }
    let mut times = vec![Vec::with_capacity(rounds); sides];
    for round in 0..rounds {
        for turn in 0..sides {
            let side = (turn + round) % sides;
            times[side].push(seconds(side)?);
        }
    }
    Ok(times.into_iter().map(median).collect())
}

fn duel_by<A, B>(
    rounds: usize,
    mut ours: impl FnMut() -> Result<A>,
    mut peer: impl FnMut() -> Result<B>,
    peer_clock: fn() -> f64,
) -> Result<Duel> {
    let our_repeats = repeats(sample(&mut ours, 1, cpu_seconds)?);
    let peer_repeats = repeats(sample(&mut peer, 1, peer_clock)?);
    let (mut our_times, mut peer_times) = (Vec::with_capacity(rounds), Vec::with_capacity(rounds));
    for round in 0..rounds {
        if round % 2 == 0 {
            our_times.push(sample(&mut ours, our_repeats, cpu_seconds)?);
            peer_times.push(sample(&mut peer, peer_repeats, peer_clock)?);
        } else {
            peer_times.push(sample(&mut peer, peer_repeats, peer_clock)?);
            our_times.push(sample(&mut ours, our_repeats, cpu_seconds)?);
        }
    }
    Ok(Duel { ours: median(our_times), peer: median(peer_times) })
}

/// How often work that takes `seconds` has to run for one sample.
fn repeats(seconds: f64) -> usize {
    (SHORTEST_SAMPLE / seconds.max(1e-9)).ceil() as usize
}

/// Seconds by `clock` of one run of `work`, from `repeats` of them.
fn sample<T>(work: &mut impl FnMut() -> Result<T>, repeats: usize, clock: fn() -> f64) -> Result<f64> {
    let start = clock();
    for _ in 1..repeats {
        black_box(work()?);
    }
    let last = black_box(work()?);
    let seconds = (clock() - start) / repeats as f64;
    drop(last);
    Ok(seconds)
}

/// What one piece of work took.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spent {
    pub(crate) cpu_seconds: f64,
    pub(crate) wall_seconds: f64,
}

/// Runs `work` once, for figures that are the same in every run and cost much.
pub(crate) fn once<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, Spent)> {
    let (wall, cpu) = (Instant::now(), cpu_seconds());
    let made = black_box(work()?);
    Ok((made, Spent { cpu_seconds: cpu_seconds() - cpu, wall_seconds: wall.elapsed().as_secs_f64() }))
}

/// The middle value, or the mean of the two middle ones; NaN of nothing.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let (below, above) = (values.len().saturating_sub(1) / 2, values.len() / 2);
    match (values.get(below), values.get(above)) {
        (Some(a), Some(b)) => (a + b) / 2.0,
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn median_of_odd_even_one_and_none() {
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0, 4.0]), 3.0);
        assert_eq!(median(vec![7.0]), 7.0);
        assert!(median(vec![]).is_nan());
    }

    #[test]
    fn short_work_is_repeated_and_long_work_is_not() {
        assert_eq!(repeats(1.0), 1);
        assert_eq!(repeats(SHORTEST_SAMPLE), 1);
        assert_eq!(repeats(SHORTEST_SAMPLE / 3.5), 4);
        assert!(repeats(0.0) > 1_000_000);
    }

    #[test]
    fn sides_take_turns_and_each_begins() {
        let log = RefCell::new(String::new());
        let side = |name: char| {
            let log = &log;
            move || {
                log.borrow_mut().push(name);
                // Longer than a sample has to be, so that it runs once each time.
                let start = cpu_seconds();
                while cpu_seconds() - start <= SHORTEST_SAMPLE {}
                Ok(())
            }
        };
        let found = duel(3, side('o'), side('p')).unwrap();
        assert_eq!(
            log.into_inner(),
            "op" /* warm-up */
                .to_owned()
                + "op"
                + "po"
                + "op"
        );
        assert!(found.ours > SHORTEST_SAMPLE && found.peer > SHORTEST_SAMPLE);
    }

    #[test]
    fn many_sides_take_turns_and_each_begins() {
        let mut log = Vec::new();
        let times = turns(3, 3, |side| {
            log.push(side);
            Ok(if log.len() <= 3 { 99.0 } else { log.len() as f64 })
        });
        assert_eq!(log, [0, 1, 2, 0, 1, 2, 1, 2, 0, 2, 0, 1]);
        // Called as number 4, 9 and 11; 5, 7 and 12; 6, 8 and 10.
        assert_eq!(times.unwrap(), [9.0, 7.0, 8.0]);
        assert!(turns(1, 2, |side| if side == 1 { anyhow::bail!("no") } else { Ok(1.0) }).is_err());
    }

    #[test]
    fn failure_of_a_side_is_told() {
        assert!(duel(1, || Ok(()), || -> Result<()> { anyhow::bail!("no") }).is_err());
    }
}
