//! Pictures of runs: red grains flow along the wave, blue ones against it, and the wall stands around.

#![allow(clippy::unwrap_used, reason = "what is missing fails the test")]

mod common;

use peristalsis_run::{
    Aspect, Field, Frame, FrameSource, Look, Picture, PictureScene, Place, Run, Span, Trajectory,
    TrajectoryFormat, TrajectoryPlan, TrajectoryRequest, WallLook, Window, space_time,
};

fn look(width: u32) -> Look {
    Look {
        width,
        ..Look::default()
    }
}

/// The bare picture of a run as it is.
fn picture(run: &Run, look: Look) -> Picture {
    let frame = FrameSource::now(run, look.needs_contacts());
    let scene = PictureScene::new(run, look, std::slice::from_ref(&frame)).unwrap();
    scene.picture(&frame).unwrap()
}

fn refusal(run: &Run, look: Look) -> String {
    let frame = FrameSource::now(run, true);
    PictureScene::new(run, look, &[frame])
        .unwrap_err()
        .to_string()
}

/// Pixels that are clearly red, and clearly blue.
fn colours(picture: &Picture) -> (usize, usize) {
    let (mut red, mut blue) = (0, 0);
    for pixel in picture.pixels().chunks_exact(3) {
        let [r, b] = [0, 2].map(|channel| i32::from(pixel[channel]));
        red += usize::from(r > b + 60);
        blue += usize::from(b > r + 60);
    }
    (red, blue)
}

fn jammed(direction: &str) -> Run {
    let settings =
        format!("drive.direction={direction} initial.state=jammed tube.waves=2 grains.number=60");
    Run::new(common::configuration("frictionless", &settings)).unwrap()
}

#[test]
fn jammed_grains_are_red_whichever_way_the_wave_runs() {
    for direction in ["forward", "backward"] {
        let run = jammed(direction);
        for wall in [WallLook::Cut, WallLook::Glass, WallLook::Hidden] {
            let side = picture(&run, Look { wall, ..look(400) });
            let (red, blue) = colours(&side);
            assert!(red > 2_000 && blue == 0, "{red} red and {blue} blue pixels");
            // White beside the tube, and the wall at the middle of its upper edge.
            assert_eq!(side.pixel(0, 0), [255; 3]);
            if wall == WallLook::Hidden {
                continue;
            }
            let column = (0..side.height()).map(|row| side.pixel(200, row));
            let edge = column.into_iter().find(|pixel| pixel[0] < 230).unwrap();
            let apart = edge.iter().max().unwrap() - edge.iter().min().unwrap();
            assert!(apart < 40, "{edge:?}");
        }
    }
}

/// A frame of a run with one grain of its own.
fn one_grain(run: &Run, position: [f64; 3], along: f64) -> Frame {
    let mut frame = FrameSource::now(run, false);
    frame.position.splice(..frame.grains, [position]);
    frame.velocity.splice(..frame.grains, [[0.0, 0.0, along]]);
    frame.diameter.splice(..frame.grains, [1.0]);
    frame.turns.splice(..frame.grains, [0]);
    frame.grains = 1;
    frame
}

#[test]
fn a_grain_is_where_it_is_and_in_its_colour() {
    let run = jammed("forward");
    let wall = run.simulation().wall();
    let (heading, length) = (wall.heading(), wall.length());
    let speed = wall.frequency(0.0) * wall.wavelength();
    let bare = Look {
        wall: WallLook::Hidden,
        ..look(500)
    };
    for (ratio, is) in [
        (1.0, (|[r, _, b]| r > 2 * b) as fn([u8; 3]) -> bool),
        (-1.0, |[r, _, b]| b > 2 * r),
        (0.0, |[r, g, b]| {
            r > 190 && r.abs_diff(b) < 12 && r.abs_diff(g) < 12
        }),
    ] {
        let frame = one_grain(&run, [0.0, 0.4, 0.25 * length], heading * ratio * speed);
        let scene = PictureScene::new(&run, bare, std::slice::from_ref(&frame)).unwrap();
        let picture = scene.picture(&frame).unwrap();
        // The wave runs to the right, towards -z, so that z = L/4 is at three quarters of the picture.
        let scale = 500.0 / (length + 1.2);
        let column = (0.6 + 0.75 * length) * scale;
        let row = 0.5 * f64::from(picture.height()) - 0.4 * scale;
        let seen = picture.pixel(column as u32, row as u32);
        assert!(is(seen), "v/c = {ratio}: {seen:?}");
        let marked = picture
            .pixels()
            .chunks_exact(3)
            .filter(|pixel| *pixel != [255; 3])
            .count() as f64;
        let disc = std::f64::consts::PI * 0.25 * scale * scale;
        assert!(
            (marked / disc - 1.0).abs() < 0.25,
            "{marked} pixels for {disc}"
        );
    }
}

#[test]
fn gravity_across_the_tube_points_down() {
    let row_of = |gravity: &str, place: [f64; 3]| {
        let settings = format!("tube.waves=2 grains.number=60 body.gravity={gravity}");
        let run = Run::new(common::configuration("frictionless", &settings)).unwrap();
        [Aspect::Side, Aspect::Section(Place::At(5.0))].map(|aspect| {
            let bare = Look {
                aspect,
                wall: WallLook::Hidden,
                ..look(300)
            };
            let frame = one_grain(&run, place, 0.0);
            let scene = PictureScene::new(&run, bare, std::slice::from_ref(&frame)).unwrap();
            let picture = scene.picture(&frame).unwrap();
            let mut pixels = picture.pixels().chunks_exact(3);
            let first = pixels.position(|pixel| pixel != [255; 3]).unwrap();
            (first / 300) as f64 / f64::from(picture.height())
        })
    };
    for (gravity, down) in [
        ("[0,-0.001,0]", [0.0, -1.0]),
        ("[0.001,0,0.001]", [1.0, 0.0]),
    ] {
        let [lower, upper] =
            [1.0, -1.0].map(|side| row_of(gravity, [side * down[0], side * down[1], 5.0]));
        for (lower, upper) in lower.into_iter().zip(upper) {
            assert!(upper < lower, "{gravity}: {upper} above {lower}");
        }
    }
}

#[test]
fn a_mirrored_tube_gives_the_mirrored_outline() {
    let run = jammed("forward");
    let bare = Look {
        wall: WallLook::Hidden,
        ..look(300)
    };
    let length = run.simulation().wall().length();
    let outline = |z: f64| -> Vec<Vec<bool>> {
        let frame = one_grain(&run, [0.3, 0.1, z], 0.0);
        let scene = PictureScene::new(&run, bare, std::slice::from_ref(&frame)).unwrap();
        let picture = scene.picture(&frame).unwrap();
        let rows = picture.pixels().chunks_exact(3 * 300);
        rows.map(|row| {
            row.chunks_exact(3)
                .map(|pixel| *pixel != [255; 3])
                .collect()
        })
        .collect()
    };
    let (one, mut other) = (outline(0.3 * length), outline(0.7 * length));
    other.iter_mut().for_each(|row| row.reverse());
    let (one, other) = (one.concat(), other.concat());
    assert!(one.iter().filter(|mark| **mark).count() > 100);
    // Rounding may move the edge of a disc by a part of a pixel.
    let differing = one.iter().zip(&other).filter(|(a, b)| a != b).count();
    assert!(differing <= 4, "{differing} pixels");
}

#[test]
fn grains_that_flow_against_the_wave_are_blue() {
    let settings = "initial.state=jammed initial.axial_velocity=-0.05 grains.number=300";
    let run = Run::new(common::configuration("frictional", settings)).unwrap();
    let (red, blue) = colours(&picture(&run, look(400)));
    assert!(blue > 500 && red == 0, "{red} red and {blue} blue pixels");
    let section = Look {
        aspect: Aspect::Section(Place::Position(0.25)),
        ..look(120)
    };
    let section = picture(&run, section);
    assert_eq!((section.width(), section.height()), (120, 120));
}

#[test]
fn every_field_colours_the_grains_of_a_run_that_has_it() {
    let settings = "initial.state=jammed grains.number=200";
    let mut run = Run::new(common::configuration("frictional", settings)).unwrap();
    run.advance().unwrap();
    let mut seen = Vec::new();
    for field in [
        Field::AxialVelocity,
        Field::Speed,
        Field::Diameter,
        Field::AxialDisplacement,
        Field::AngularVelocity,
        Field::Position,
        Field::Coordination,
        Field::Pressure,
    ] {
        let picture = picture(&run, Look { field, ..look(200) });
        assert!(
            !seen.contains(&picture),
            "{field:?} looks like another field"
        );
        seen.push(picture);
    }
    let smooth = jammed("forward");
    let turning = Look {
        field: Field::AngularVelocity,
        ..look(200)
    };
    assert!(refusal(&smooth, turning).contains("do not rotate"));
}

#[test]
fn contacts_are_drawn_between_smaller_grains() {
    let mut run = jammed("forward");
    (0..40).for_each(|_| run.advance().unwrap());
    let plain = picture(&run, look(600));
    let contacts = true;
    let forces = picture(
        &run,
        Look {
            contacts,
            ..look(600)
        },
    );
    // Grains of a jam are red; forces are warm and bright, or violet where they are weak.
    let bright = |picture: &Picture| {
        let pixels = picture.pixels().chunks_exact(3);
        pixels
            .filter(|it| it[0] > 200 && it[1] > 110 && i32::from(it[0]) > i32::from(it[2]) + 60)
            .count()
    };
    assert!(
        bright(&forces) > bright(&plain) + 50,
        "{} pixels of forces",
        bright(&forces)
    );
}

#[test]
fn a_static_wave_has_no_speed_to_compare_with_and_no_grains_are_no_failure() {
    let settings = "drive.strain_rate=0 run.duration=5 grains.number=0";
    let run = Run::new(common::configuration("frictionless", settings)).unwrap();
    let side = picture(&run, look(200));
    assert_eq!(colours(&side), (0, 0));
    assert!(
        side.pixels().iter().any(|byte| *byte < 200),
        "there is a wall"
    );
    let frame = FrameSource::now(&run, false);
    PictureScene::new(&run, look(200), std::slice::from_ref(&frame))
        .unwrap()
        .draw(&frame)
        .unwrap();
    let settings = "drive.strain_rate=0 run.duration=5 grains.number=10";
    let with_grains = Run::new(common::configuration("frictionless", settings)).unwrap();
    let with_grains = common::finish(with_grains);
    assert!(!with_grains.recorder().waves().is_empty());
    for run in [run, with_grains] {
        let refusal = space_time(&run).unwrap_err().to_string();
        assert!(refusal.contains("no whole period"), "{refusal}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused_in_words() {
    let run = jammed("forward");
    for width in [0, 15, 20_000] {
        assert!(refusal(&run, look(width)).contains("beyond reach"));
    }
    let section = |place| Look {
        aspect: Aspect::Section(Place::At(place)),
        ..look(100)
    };
    assert!(refusal(&run, section(1e3)).contains("no place z = 1000"));
    let range = Look {
        range: Some((1.0, 1.0)),
        ..look(100)
    };
    assert!(refusal(&run, range).contains("from 1 to 1"));
    for waves in [0.0, f64::NAN] {
        let words = refusal(&run, Look { waves, ..look(100) });
        assert!(words.contains("waves"), "{words}");
    }
}

#[test]
fn frames_of_a_trajectory_are_those_that_are_computed() {
    // Instants are in periods of drive.strain_rate, however far the wave has come.
    let settings = "tube.waves=2 grains.number=40 run.periods=3 \
                    drive.schedule={form='ramp',parameter='strain_rate',from=0.05,to=0.02,end=3}";
    let configuration = || common::configuration("frictionless", settings);
    let request = TrajectoryRequest {
        formats: vec![TrajectoryFormat::Gsd],
        every: Some(Span::Periods(0.25)),
        window: Window::default(),
    };
    let steps = configuration().run.steps();
    let plan = || TrajectoryPlan::new(&request, &configuration(), 0, steps).unwrap();
    let place = tempfile::tempdir().unwrap();
    let mut run = Run::new(configuration()).unwrap();
    let mut trajectory = Trajectory::begin(place.path(), plan(), &mut run).unwrap();
    while let Some(steps) = trajectory.steps_to_next(&run) {
        run.advance_at_most(steps).unwrap();
        trajectory.observe(&run).unwrap();
    }
    trajectory.synchronize().unwrap();
    let path = FrameSource::in_folder(place.path()).unwrap();

    let all = |source: &mut FrameSource| {
        let mut frames = Vec::new();
        while !source.is_over() {
            frames.extend(source.step().unwrap());
        }
        frames
    };
    let read =
        all(&mut FrameSource::of_file(&path, &configuration(), None, Window::default()).unwrap());
    let mut computed = FrameSource::of_run(Run::new(configuration()).unwrap(), plan(), false);
    assert_eq!(computed.frames(), 13);
    let computed = all(&mut computed);
    assert_eq!(read.len(), 13);
    for (one, other) in read.iter().zip(&computed) {
        assert_eq!(
            (one.step, one.time, one.grains),
            (other.step, other.time, other.grains)
        );
        assert_eq!(one.value("period"), other.value("period"));
        for (a, b) in one.position.iter().zip(&other.position) {
            let apart = a
                .iter()
                .zip(b)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(
                apart < 1e-5 || (apart - one.length).abs() < 1e-5,
                "{a:?} {b:?}"
            );
        }
    }
    // A window, every second frame of it, and the frame nearest to an instant.
    let window = Window {
        from: Some(Span::Periods(1.0)),
        to: Some(Span::Periods(2.0)),
    };
    let some =
        all(
            &mut FrameSource::of_file(&path, &configuration(), Some(Span::Periods(0.5)), window)
                .unwrap(),
        );
    let period = configuration().drive.period().unwrap();
    let quarters = some.iter().map(|frame| (4.0 * frame.time / period).round());
    assert_eq!(quarters.collect::<Vec<_>>(), [4.0, 6.0, 8.0]);
    let [first, nearest] =
        FrameSource::nearest(&path, &configuration(), Some(Span::Periods(1.3))).unwrap();
    assert_eq!((first.step, nearest.step), (read[0].step, read[5].step));
    let beyond = Window {
        from: Some(Span::Periods(7.0)),
        to: None,
    };
    let refused = FrameSource::of_file(&path, &configuration(), None, beyond)
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("none of the 13 frames") && refused.contains("3.00"),
        "{refused}"
    );
    // A trajectory of another tube.
    let other = Run::new(common::configuration(
        "frictionless",
        "tube.waves=3 grains.number=40",
    ))
    .unwrap();
    let scene = PictureScene::new(&other, look(64), &[FrameSource::now(&other, false)]).unwrap();
    let words = scene.picture(&read[0]).unwrap_err().to_string();
    assert!(
        words.contains("20 d long") && words.contains("30 d"),
        "{words}"
    );
}

#[test]
fn the_space_time_diagram_has_a_row_a_wave_and_a_column_a_period() {
    let settings = "tube.waves=3 grains.number=30 run.periods=4";
    let run = common::finish(Run::new(common::configuration("frictionless", settings)).unwrap());
    assert_eq!(run.recorder().waves().len(), 12);
    let drawing = space_time(&run).unwrap();
    assert!(drawing.svg().contains("number of the wave"));
    assert!(drawing.png().unwrap().len() > 5_000);
}

/// A pump engineer: the columns of a run with a pause were as wide as all its wavelengths over their number, under a time that
/// was not that of the flow's figure.
#[test]
fn the_space_time_diagram_of_a_wave_that_pauses_has_the_time_of_the_flow() {
    let pause = "drive.schedule={form='steps',parameter='strain_rate',at=[1,3],values=[0,0.05]}";
    let settings = format!("tube.waves=3 grains.number=30 run.periods=4 {pause}");
    let mut run = Run::new(common::configuration("frictionless", &settings)).unwrap();
    while !run.is_complete() {
        run.advance().unwrap();
    }
    assert!((run.recorder().waves().last().unwrap().period - 2.0).abs() < 1e-9);
    let numbers = |svg: &str| -> Vec<f64> {
        let words = svg.split('"');
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let found = numbers(&space_time(&run).unwrap().svg());
    assert!(found.contains(&4.0), "{found:?}");
}

/// A film of a run with a pause ended at the first frame of the pause: without marks the page was lower.
#[test]
fn frames_of_a_wave_that_pauses_have_one_layout() {
    let pause =
        "drive.schedule={form='steps',parameter='strain_rate',at=[0.2,0.4],values=[0,0.05]}";
    let settings = format!("tube.waves=2 grains.number=30 run.periods=1 {pause}");
    let mut run = Run::new(common::configuration("frictionless", &settings)).unwrap();
    let first = FrameSource::now(&run, false);
    let scene = PictureScene::new(&run, look(300), std::slice::from_ref(&first)).unwrap();
    let (mut sizes, mut said) = (Vec::new(), Vec::new());
    while !run.is_complete() {
        let drawing = scene.draw(&FrameSource::now(&run, false)).unwrap();
        sizes.push(drawing.size());
        said.push(drawing.svg().contains("wave stands"));
        run.advance().unwrap();
    }
    sizes.dedup();
    assert_eq!(sizes.len(), 1, "{sizes:?}");
    assert!(said.contains(&true) && !said[0], "{said:?}");
}

#[test]
fn contacts_are_drawn_with_a_bar_of_their_forces_and_in_a_section_only_its_own() {
    let settings = "drive.width=1.4 initial.state=jammed tube.waves=2 grains.number=60";
    let mut run = Run::new(common::configuration("frictionless", settings)).unwrap();
    (0..20).for_each(|_| run.advance().map(drop).unwrap());
    let throat = run.simulation().wall().throat();
    let of = |wall: WallLook, contacts: bool| Look {
        aspect: Aspect::Section(Place::Position(throat)),
        wall,
        contacts,
        ..look(300)
    };
    // How far from the middle something is drawn.
    let reach = |look: Look| {
        let picture = picture(&run, look);
        let pixels = picture.pixels().chunks_exact(3).enumerate();
        let drawn = pixels.filter(|(_, pixel)| pixel.iter().any(|&byte| byte < 250));
        let away = drawn.map(|(at, _)| {
            let [x, y] = [at % 300, at / 300].map(|place| place as f64 - 149.5);
            x.hypot(y)
        });
        away.fold(0.0, f64::max)
    };
    let (of_contacts, of_wall) = (
        reach(of(WallLook::Hidden, true)),
        reach(of(WallLook::Cut, false)),
    );
    assert!(of_contacts < of_wall, "{of_contacts} {of_wall}");
    // A film knows its first picture alone, in which nothing may touch.
    let first = FrameSource::now(&Run::new(run.configuration().clone()).unwrap(), true);
    let now = FrameSource::now(&run, true);
    for contacts in [true, false] {
        let side = Look {
            contacts,
            ..look(400)
        };
        let scene = PictureScene::new(&run, side, std::slice::from_ref(&first)).unwrap();
        for frame in [&first, &now] {
            let svg = scene.draw(frame).unwrap().svg();
            // The picture, and bars of colours.
            assert_eq!(svg.matches("<image").count(), 2 + usize::from(contacts));
        }
        // The colours of large forces, which no grain and no wall has.
        let picture = scene.picture(&now).unwrap();
        let pixels = picture.pixels().chunks_exact(3);
        let is_yellow = |pixel: &&[u8]| pixel[1].saturating_sub(pixel[2]) > 60;
        let yellow = pixels.filter(is_yellow).count();
        assert_eq!(yellow > 8, contacts, "{yellow} pixels");
    }
}
