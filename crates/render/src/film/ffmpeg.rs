//! Films through ffmpeg, if it is there.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::{Film, FilmFormat, FilmPlan, of_one_size};
use crate::error::RenderError;
use crate::picture::Picture;

/// The variable that names another ffmpeg than the one on the path.
const PROGRAM: &str = "FFMPEG";

/// A film that ffmpeg is writing.
pub(super) struct FfmpegFilm {
    format: FilmFormat,
    path: PathBuf,
    plan: FilmPlan,
    begun: Option<((u32, u32), Child)>,
}

impl FfmpegFilm {
    pub(super) fn new(format: FilmFormat, path: &Path, plan: FilmPlan) -> Self {
        Self {
            format,
            path: path.to_owned(),
            plan,
            begun: None,
        }
    }

    fn begin(&self, (width, height): (u32, u32)) -> Result<Child, RenderError> {
        let program = std::env::var_os(PROGRAM).unwrap_or_else(|| "ffmpeg".into());
        let [red, green, blue] = self.plan.paper;
        let speed = self.plan.frames_per_second.to_string();
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
        match self.format {
            FilmFormat::Webm => command.args([
                "-c:v",
                "libvpx-vp9",
                "-crf",
                "28",
                "-b:v",
                "0",
                "-f",
                "webm",
            ]),
            _ => command.args([
                "-c:v",
                "libx264",
                "-crf",
                "17",
                "-preset",
                "slow",
                "-movflags",
                "+faststart",
                "-f",
                "mp4",
            ]),
        };
        command
            .arg(&self.path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|source| RenderError::NoFfmpeg {
                program: program.to_string_lossy().into_owned(),
                source,
            })
    }
}

impl Film for FfmpegFilm {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let size = of_one_size(self.begun.as_ref().map(|(size, _)| *size), picture)?;
        if self.begun.is_none() {
            self.begun = Some((size, self.begin(size)?));
        }
        let Some((_, child)) = &mut self.begun else {
            return Err(RenderError::Frames);
        };
        let written = match &mut child.stdin {
            Some(stdin) => stdin.write_all(picture.pixels()),
            None => Err(std::io::ErrorKind::BrokenPipe.into()),
        };
        match written {
            Ok(()) => Ok(()),
            // It has ended before its time, and says why.
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Err(ended(child)),
            Err(error) => Err(RenderError::Film(error)),
        }
    }

    fn finish(mut self: Box<Self>) -> Result<(), RenderError> {
        let Some((_, child)) = &mut self.begun else {
            return Err(RenderError::Frames);
        };
        drop(child.stdin.take());
        match child.wait() {
            Ok(status) if status.success() => Ok(()),
            Ok(_) => Err(ended(child)),
            Err(error) => Err(RenderError::Film(error)),
        }
    }
}

impl Drop for FfmpegFilm {
    fn drop(&mut self) {
        if let Some((_, child)) = &mut self.begun {
            // A film that is given up must not go on; one that has ended is not hurt.
            drop(child.kill());
            drop(child.wait());
        }
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
