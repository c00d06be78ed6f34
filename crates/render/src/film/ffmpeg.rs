//! Films through ffmpeg, if it is there.

use std::ffi::{OsStr, OsString};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::{Encoder, FilmFormat, FilmPlan, Size};
use crate::error::RenderError;
use crate::picture::Picture;

/// The variable that names another ffmpeg than the one on the path.
const PROGRAM: &str = "FFMPEG";

fn program() -> OsString {
    std::env::var_os(PROGRAM).unwrap_or_else(|| "ffmpeg".into())
}

fn missing(program: &OsStr) -> impl FnOnce(std::io::Error) -> RenderError {
    let program = program.to_string_lossy().into_owned();
    move |source| RenderError::NoFfmpeg { program, source }
}

/// Whether ffmpeg begins at all.
pub(super) fn available() -> Result<(), RenderError> {
    let program = program();
    let mut command = Command::new(&program);
    let silent = command
        .arg("-version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    silent.status().map(drop).map_err(missing(&program))
}

/// ffmpeg at work on a film.
pub(super) struct Ffmpeg(Child);

impl Ffmpeg {
    pub(super) fn new(
        format: FilmFormat,
        path: &Path,
        plan: FilmPlan,
        (width, height): Size,
    ) -> Result<Self, RenderError> {
        let program = program();
        let [red, green, blue] = plan.paper;
        let speed = plan.frames_per_second.to_string();
        let mut command = Command::new(&program);
        command
            .args(["-nostdin", "-loglevel", "error", "-y", "-f", "rawvideo"])
            .args(["-pixel_format", "rgb24", "-video_size"])
            .arg(format!("{width}x{height}"))
            .args(["-framerate", &speed, "-i", "pipe:0", "-vf"])
            // Half as many colours as pixels need even sides.
            .arg(format!(
                "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=0x{red:02x}{green:02x}{blue:02x},format=yuv420p"
            ));
        let codec = match format {
            FilmFormat::Webm => "-c:v libvpx-vp9 -crf 28 -b:v 0 -f webm",
            _ => "-c:v libx264 -crf 17 -preset slow -movflags +faststart -f mp4",
        };
        let child = command
            .args(codec.split(' '))
            .arg(path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(missing(&program))?;
        Ok(Self(child))
    }
}

impl Encoder for Ffmpeg {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let written = match &mut self.0.stdin {
            Some(stdin) => stdin.write_all(picture.pixels()),
            None => Err(std::io::ErrorKind::BrokenPipe.into()),
        };
        written.map_err(|error| match error.kind() {
            // It has ended before its time, and says why.
            std::io::ErrorKind::BrokenPipe => ended(&mut self.0),
            _ => RenderError::Film(error),
        })
    }

    fn finish(mut self: Box<Self>) -> Result<(), RenderError> {
        drop(self.0.stdin.take());
        match self.0.wait() {
            Ok(status) if status.success() => Ok(()),
            Ok(_) => Err(ended(&mut self.0)),
            Err(error) => Err(RenderError::Film(error)),
        }
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        // A film that is given up must not go on; one that has ended is not hurt.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Why ffmpeg ended, in its words.
fn ended(child: &mut Child) -> RenderError {
    drop(child.stdin.take());
    let mut words = String::new();
    if let Some(stderr) = &mut child.stderr {
        // Without words there is still the failure.
        drop(stderr.read_to_string(&mut words));
    }
    RenderError::Ffmpeg {
        words: words.trim().to_owned(),
    }
}
