//! What was filmed is seen again.

use super::*;

/// A white field with a red square that wanders.
fn picture(number: u32) -> Picture {
    let (width, height) = (60, 30);
    let pixels = (0..width * height).flat_map(|place| {
        let (x, y) = (place % width, place / width);
        let is_red = (5 * number..5 * number + 10).contains(&x) && (8..20).contains(&y);
        if is_red {
            [200, 20, 30]
        } else {
            [255, 255, 255]
        }
    });
    Picture::new(width, height, pixels.collect())
}

const PLAN: FilmPlan = FilmPlan {
    frames: 7,
    frames_per_second: 30.0,
    paper: [255; 3],
};

fn film(format: FilmFormat, path: &Path) {
    let mut film = format.create(path, PLAN).unwrap();
    for number in 0..7 {
        film.add(&picture(number)).unwrap();
    }
    film.finish().unwrap();
}

fn temporary(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!("peristalsis-{}-{name}", std::process::id()))
}

#[test]
fn an_animated_png_holds_every_picture_exactly() {
    let path = temporary("film.apng");
    film(FilmFormat::Apng, &path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (7, 0));
    let mut seen = vec![0; reader.output_buffer_size().unwrap()];
    for number in 0..7 {
        reader.next_frame(&mut seen).unwrap();
        assert!(seen == picture(number).pixels(), "picture {number}");
        let frame = reader.info().frame_control.unwrap();
        assert_eq!(
            f64::from(frame.delay_den) / f64::from(frame.delay_num),
            30.0
        );
    }
}

#[test]
fn a_gif_shows_every_picture_nearly_and_in_its_time() {
    let path = temporary("film.gif");
    film(FilmFormat::Gif, &path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let mut reader = ::gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
    let mut screen = vec![0_u8; 60 * 30 * 3];
    let (mut frames, mut delay) = (0, 0);
    while let Some(frame) = reader.read_next_frame().unwrap() {
        let colours = frame.palette.as_ref().unwrap();
        let across = usize::from(frame.width);
        for (place, &index) in frame.buffer.iter().enumerate() {
            if Some(index) == frame.transparent {
                continue;
            }
            let (x, y) = (
                place % across + usize::from(frame.left),
                place / across + usize::from(frame.top),
            );
            let colour = &colours[3 * usize::from(index)..3 * usize::from(index) + 3];
            screen[3 * (60 * y + x)..3 * (60 * y + x) + 3].copy_from_slice(colour);
        }
        let expected = picture(frames);
        let worst = screen
            .iter()
            .zip(expected.pixels())
            .map(|(one, other)| one.abs_diff(*other))
            .max();
        assert!(worst.unwrap() < 12, "picture {frames}: {worst:?}");
        assert_eq!(screen[..3], [255; 3]);
        frames += 1;
        delay += frame.delay;
    }
    // 7/30 s.
    assert_eq!((frames, delay), (7, 23));
}

#[test]
fn pictures_of_two_sizes_are_no_film_and_neither_is_none() {
    let path = temporary("sizes.gif");
    for format in [FilmFormat::Gif, FilmFormat::Apng] {
        let mut film = format.create(&path, PLAN).unwrap();
        film.add(&picture(0)).unwrap();
        let other = film.add(&Picture::new(2, 1, vec![0; 6])).unwrap_err();
        assert!(other.to_string().contains("2 x 1"), "{other}");
        let none = format.create(&path, PLAN).unwrap().finish();
        assert!(matches!(none, Err(RenderError::Frames)));
        for frames_per_second in [0.0, 1e3, f64::NAN] {
            let plan = FilmPlan {
                frames_per_second,
                ..PLAN
            };
            let refused = format.create(&path, plan).err().unwrap();
            assert!(refused.to_string().contains("0.1 to 120"), "{refused}");
        }
    }
    std::fs::remove_file(&path).unwrap();
}
