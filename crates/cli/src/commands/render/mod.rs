//! `peristalsis render`

mod arguments;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time;

use peristalsis_formats::atomic::{self, Pending};
use peristalsis_run::{
    Drawing, Field, FilmFormat, FilmPlan, Frame, FrameSource, Look, Picture, PictureScene, Run,
    RunError, RunFolder, Span, TrajectoryFormat, TrajectoryPlan, TrajectoryRequest, Window,
    space_time,
};
use serde_json::json;

pub(crate) use self::arguments::RenderArguments;
use self::arguments::{FRAMES_PER_SECOND, Origin};
use crate::choice::{Format, View};
use crate::commands::{counted, packing, print, refuse_loss, rounded, say, say_if_replaced};
use crate::failure::Failure;
use crate::progress::Display;
use crate::stop::Stop;

/// How long a film goes on from a saved state, and the time between its frames where they are computed, in periods.
const DURATION: Span = Span::Periods(2.0);
const INTERVAL: Span = Span::Periods(0.05);

pub(crate) fn render(arguments: &RenderArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let format = format(arguments)?;
    check(arguments, format)?;
    let (folder, run) = RunFolder::open(&arguments.folder)?;
    let name = match arguments.view {
        View::Side => "tube-side",
        View::Section => "tube-section",
        View::SpaceTime => "tube-space-time",
    };
    let usual = || folder.path().join(format!("{name}.{}", format.extension()));
    let out = arguments.out.clone().unwrap_or_else(usual);
    refuse_loss(&out, folder.files())?;
    if arguments.view == View::SpaceTime {
        let diagram = space_time(&run)?;
        return finish_picture(arguments, &out, format, (&diagram, None));
    }
    let middle = 0.5 * run.simulation().wall().length();
    let look = arguments.look(format.film().is_some(), middle);
    if let Some(film) = format.film() {
        return make_film(arguments, run, look, film, &out, &stop);
    }
    match still(arguments, run, look, &stop)? {
        Some((drawing, instant)) => {
            finish_picture(arguments, &out, format, (&drawing, Some(instant)))
        }
        None => Ok(stop.exit_code()),
    }
}

const ENDINGS: &str =
    "endings: .png, .svg, .gif, .apng, .mp4, .webm; or name the format with --format";

/// What is to be made.
fn format(arguments: &RenderArguments) -> Result<Format, Failure> {
    let by_name = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let known = ending.and_then(Format::by_ending);
        known.ok_or_else(|| {
            let unknown = format!(
                "{}: no picture or film is known by this ending",
                path.display()
            );
            Failure::usage(unknown, ENDINGS)
        })
    };
    let format = match (arguments.format, &arguments.out) {
        (Some(format), _) => format,
        (None, Some(out)) => by_name(out)?,
        (None, None) if arguments.film => Format::Film(FilmFormat::Gif),
        (None, None) => Format::Png,
    };
    if let (Some(chosen), Some(Ok(named))) = (arguments.format, arguments.out.as_ref().map(by_name))
        && chosen != named
    {
        let (out, chosen, named) = (&arguments.out, chosen.extension(), named.extension());
        let out = out.as_deref().unwrap_or(Path::new("")).display();
        return Err(Failure::usage(
            format!(
                "--format {chosen} contradicts the ending of --out {out}, which is that of {named}"
            ),
            format!("leave --format out, or let the name end in .{chosen}"),
        ));
    }
    if arguments.film && format.film().is_none() {
        return Err(Failure::usage(
            format!("{} is no format of films", format.extension()),
            "films: gif, apng, and with ffmpeg mp4, webm",
        ));
    }
    Ok(format)
}

/// Refuses what goes together with no picture.
fn check(arguments: &RenderArguments, format: Format) -> Result<(), Failure> {
    let is_film = format.film().is_some();
    let is_placed = arguments.place.is_some() || arguments.position.is_some();
    let (has_window, has_duration) = (arguments.window.is_some(), arguments.duration.is_some());
    let has_rate = arguments.every.is_some() || arguments.fps.is_some();
    let is_from_side =
        arguments.wall.is_some() || arguments.eye.is_some() || arguments.waves.is_some();
    let is_of_frame = arguments.colour.is_some()
        || arguments.range.is_some()
        || arguments.contacts
        || arguments.paper.is_some()
        || arguments.bare
        || arguments.width.is_some()
        || arguments.at.is_some()
        || arguments.from.is_some()
        || arguments.trajectory.is_some();
    let is_from_state = arguments.from == Some(Origin::State);
    let reads_file = matches!(arguments.from, None | Some(Origin::Trajectory));
    let refusals = [
        (
            is_film && arguments.view == View::SpaceTime,
            "the space-time diagram shows all times at once, and makes no film",
            "take --view side or --view section for a film, or --format png or svg for the diagram",
        ),
        (
            is_placed && arguments.view != View::Section,
            "--place and --position are those of a section",
            "add --view section",
        ),
        (
            is_from_side && arguments.view != View::Side,
            "--wall, --eye and --waves are those of a view from the side",
            "leave them out, or take --view side",
        ),
        (
            is_of_frame && arguments.view == View::SpaceTime,
            "the space-time diagram shows all times at once, and has its own colours and size",
            "leave out --colour, --range, --contacts, --paper, --bare, --width, --at, --from and --trajectory",
        ),
        (
            is_film && arguments.at.is_some(),
            "--at is the instant of a picture",
            "a film has a --window FROM:TO",
        ),
        (
            !is_film && (has_window || has_duration || has_rate),
            "--window, --duration, --every and --fps are those of a film",
            "add --film",
        ),
        (
            arguments.trajectory.is_some() && !reads_file,
            "--trajectory names a file that --from then does not read",
            "leave one of them out",
        ),
        (
            has_duration && !is_from_state,
            "--duration is how long a film goes on from the saved state",
            "add --from state, or take a --window FROM:TO of the run",
        ),
        (
            has_window && is_from_state,
            "--from state begins with the saved state",
            "take --duration SPAN",
        ),
    ];
    match refusals.into_iter().find(|(applies, ..)| *applies) {
        Some((_, reason, help)) => Err(Failure::usage(reason, help)),
        None => Ok(()),
    }
}

/// The trajectory that is asked for or, where that is left open, lies in the run's folder.
fn trajectory(arguments: &RenderArguments, look: Look) -> Result<Option<PathBuf>, Failure> {
    let path = match (&arguments.trajectory, arguments.from) {
        (Some(path), _) => path.clone(),
        (None, Some(Origin::Trajectory)) => FrameSource::in_folder(&arguments.folder)?,
        (None, None) if !look.needs_contacts() => {
            return Ok(FrameSource::in_folder(&arguments.folder).ok());
        }
        (None, _) => return Ok(None),
    };
    if look.needs_contacts() {
        return Err(Failure::usage(
            "a GSD trajectory holds no forces of contacts, which --contacts draws and pressure is made of",
            "take --from state or --from start, another field, or no --contacts",
        ));
    }
    Ok(Some(path))
}

/// The instant of a picture: its time \[t\], and the same in periods of the drive where the wave moves.
type Instant = (f64, Option<f64>);

/// The picture of an instant; `None` where it was given up on the way.
fn still(
    arguments: &RenderArguments,
    run: Run,
    look: Look,
    stop: &Stop,
) -> Result<Option<(Drawing, Instant)>, Failure> {
    let with_contacts = look.needs_contacts();
    // Where nothing is said the picture is of the saved state.
    let is_of_state = matches!(arguments.from, Some(Origin::State))
        || (arguments.from.is_none() && arguments.trajectory.is_none() && arguments.at.is_none());
    if is_of_state {
        if arguments.at.is_some() {
            return Err(Failure::usage(
                "the saved state is of one instant only",
                "leave --at out, or take --from trajectory or --from start",
            ));
        }
        let mut frames = vec![FrameSource::now(&run, with_contacts)];
        if look.counts_from_first() {
            frames.insert(0, FrameSource::now(&start_of(&run)?, with_contacts));
        }
        return Ok(Some(draw(&run, look, &frames)?));
    }
    if let Some(path) = trajectory(arguments, look)? {
        let frames = FrameSource::nearest(&path, run.configuration(), arguments.at)?;
        return Ok(Some(draw(&run, look, &frames)?));
    }
    let run = start_of(&run)?;
    let first = FrameSource::now(&run, with_contacts);
    let Some(at) = arguments.at else {
        return Ok(Some(draw(&run, look, &[first])?));
    };
    let (from, to) = (Some(at), Some(at));
    let window = Window { from, to };
    let steps = run.configuration().run.steps();
    let plan = TrajectoryPlan::new(&request(None, window), run.configuration(), 0, steps)?;
    let drawn = start_of(&run)?;
    let mut source = FrameSource::of_run(run, plan, with_contacts);
    while !source.is_over() {
        if stop.requested().is_some() {
            return Ok(None);
        }
        if let Some(frame) = source.step()? {
            return Ok(Some(draw(&drawn, look, &[first, frame])?));
        }
    }
    Ok(None)
}

/// The same run at t = 0.
fn start_of(run: &Run) -> Result<Run, Failure> {
    let configuration = run.configuration().clone();
    packing(&configuration.clone(), &[], || Run::new(configuration)).map_err(|error| match error {
        RunError::NotPlaced => Failure::usage(
            "a program placed the grains at the start of this run, from which this counts",
            "take --from trajectory, if there is one, or --from state with another --colour than axial-displacement",
        ),
        other => other.into(),
    })
}

/// The picture of the last of some frames, and its instant.
fn draw(run: &Run, look: Look, frames: &[Frame]) -> Result<(Drawing, Instant), RunError> {
    let last = &frames[frames.len() - 1];
    // A displacement counts from the first. Other fields of a wave that stands now are not told in the speed that it had.
    let stands = run.simulation().wall().frequency(last.time) == 0.0;
    let samples = match stands && look.field != Field::AxialDisplacement {
        true => &frames[frames.len() - 1..],
        false => frames,
    };
    let drawing = PictureScene::new(run, look, samples)?.draw(last)?;
    let period = run.configuration().drive.period();
    let instant = (last.time, period.map(|period| last.time / period));
    Ok((drawing, instant))
}

fn request(every: Option<Span>, window: Window) -> TrajectoryRequest {
    TrajectoryRequest {
        formats: vec![TrajectoryFormat::Gsd],
        every,
        window,
    }
}

/// Where a film's frames come from.
fn frames(arguments: &RenderArguments, run: Run, look: Look) -> Result<FrameSource, Failure> {
    let with_contacts = look.needs_contacts();
    let window = arguments.window.unwrap_or_default();
    if let Some(path) = trajectory(arguments, look)? {
        let configuration = run.configuration();
        return Ok(FrameSource::of_file(
            &path,
            configuration,
            arguments.every,
            window,
        )?);
    }
    let has_periods = run.configuration().drive.period().is_some();
    let every = arguments.every.or(has_periods.then_some(INTERVAL));
    let request = request(every, window);
    if arguments.from == Some(Origin::State) {
        let now = run.simulation().step();
        let duration = arguments.duration.unwrap_or(DURATION);
        let plan = TrajectoryPlan::onward(&request, run.configuration(), now, duration)?;
        return Ok(FrameSource::of_run(run, plan, with_contacts));
    }
    let run = start_of(&run)?;
    let steps = run.configuration().run.steps();
    let plan = TrajectoryPlan::new(&request, run.configuration(), 0, steps)?;
    Ok(FrameSource::of_run(run, plan, with_contacts))
}

fn make_film(
    arguments: &RenderArguments,
    run: Run,
    look: Look,
    format: FilmFormat,
    out: &Path,
    stop: &Stop,
) -> Result<ExitCode, Failure> {
    let start = time::Instant::now();
    format.available().map_err(RunError::from)?;
    let drawn = run.clone();
    let mut source = frames(arguments, run, look)?;
    let lost = source.lost_frames();
    if lost > 0 {
        say(&format!(
            "the last {lost} of the trajectory's frames were cut short and are left out"
        ));
    }
    if source.frames() == 1 {
        say(
            "the film has one frame: a smaller --every, a wider --window or --from start makes more",
        );
    }
    let scene = PictureScene::new(&drawn, look, &source.samples()?)?;
    let plan = FilmPlan {
        frames: source.frames() as u32,
        frames_per_second: arguments.fps.unwrap_or(FRAMES_PER_SECOND),
        paper: look.paper.srgb(),
    };
    say_if_replaced(out);
    let pending = Pending::create(out).map_err(RunError::from)?;
    let film = format.create(pending.partial_path(), plan);
    let mut film = film.map_err(RunError::from)?;
    // From here on there is something to clear away.
    stop.keep_results();
    let total = source.frames() as u64;
    let mut display = Display::new(arguments.quiet, total);
    let (mut done, mut size) = (0, (0, 0));
    while !source.is_over() {
        if stop.requested().is_some() {
            display.finish();
            say("the film was given up: nothing is left of it");
            return Ok(stop.exit_code());
        }
        let Some(frame) = source.step()? else {
            continue;
        };
        let picture = picture(&scene.draw(&frame)?)?;
        film.add(&picture).map_err(RunError::from)?;
        size = (picture.width(), picture.height());
        done += 1;
        let words = || format!("frame {done} of {total}");
        display.show([done, total], start.elapsed(), words);
    }
    film.finish().map_err(RunError::from)?;
    display.finish();
    pending.commit().map_err(RunError::from)?;
    report(arguments, out, size, (total, None))
}

/// The pixels of a page.
fn picture(drawing: &Drawing) -> Result<Picture, RunError> {
    let raster = drawing.raster();
    let raster = raster.map_err(RunError::of_figure("the picture"))?;
    Ok(Picture::new(raster.width, raster.height, raster.pixels))
}

fn finish_picture(
    arguments: &RenderArguments,
    out: &Path,
    format: Format,
    (drawing, instant): (&Drawing, Option<Instant>),
) -> Result<ExitCode, Failure> {
    let bytes = match format {
        Format::Svg => drawing.svg().into_bytes(),
        _ => drawing.png().map_err(RunError::of_figure("the picture"))?,
    };
    say_if_replaced(out);
    atomic::write(out, &bytes).map_err(RunError::from)?;
    let [width, height] = drawing.size();
    report(arguments, out, (width, height), (1, instant))
}

fn report(
    arguments: &RenderArguments,
    out: &Path,
    (width, height): (u32, u32),
    (frames, instant): (u64, Option<Instant>),
) -> Result<ExitCode, Failure> {
    let out = out.display();
    let of_instant = match instant {
        Some((time, Some(periods))) => {
            format!(" of t = {} ({periods:.2} periods)", rounded(time))
        }
        Some((time, None)) => format!(" of t = {}", rounded(time)),
        None => String::new(),
    };
    let text = if arguments.json {
        let made = json!({
            "files": [out.to_string()],
            "width": width,
            "height": height,
            "frames": frames,
            "time": instant.map(|(time, _)| time),
            "periods": instant.and_then(|(_, periods)| periods),
        });
        format!("{made:#}\n")
    } else if frames == 1 {
        format!("{width} x {height} pixels{of_instant}: {out}\n")
    } else {
        format!(
            "{} of {width} x {height} pixels: {out}\n",
            counted(frames, "frame")
        )
    };
    print(&text)
}
