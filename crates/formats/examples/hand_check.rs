//! x
use peristalsis_formats::{Table, Values, parquet, csv, atomic, checkpoint, CheckpointIdentity};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let t = Table::builder()
        .column("time", "t", "Time since the start.", Values::Real((0..5).map(|i| f64::from(i)*0.1).collect()))
        .column("flow_rate_ratio", "", "J/Jmax along the wave.", Values::Real(vec![f64::NAN, -0.0, f64::INFINITY, 5e-324, 0.1]))
        .column("contacts", "", "Pairs.", Values::Integer((0..5).map(|i| i64::MAX - i).collect()))
        .column("state", "", "Where it began.", Values::Text((0..5).map(|i| format!("ü,\"{}", i%2)).collect()))
        .column("censored", "", "No transition.", Values::Boolean((0..5).map(|i| i%2==0).collect()))
        .metadata("version", "0.1.0").metadata("configuration", "[grains]\nnumber = 3\n").build().unwrap();
    let dir = std::path::Path::new(&a[1]);
    parquet::write(&dir.join("t.parquet"), &t).unwrap();
    csv::write(&dir.join("t.csv"), &t).unwrap();
    if a.len() > 2 { println!("{:?} == {}", parquet::read(std::path::Path::new(&a[2])).map(|x| x == t), a[2]); }
    let id = CheckpointIdentity { kind: *b"engine  ", layout_version: 1, physics_hash: [0; 32] };
    let n = 1000000; let state: Vec<[f64; 12]> = (0..n).map(|i| std::array::from_fn(|j| ((i*12+j) as f64).sqrt())).collect();
    let s = std::time::Instant::now(); let b = checkpoint::encode(&id, &state).unwrap(); println!("encode {} MB {:?}", b.len()/1000000, s.elapsed());
    let s = std::time::Instant::now(); let r: Vec<[f64;12]> = checkpoint::decode(&id, &b).unwrap(); println!("decode {:?} {}", s.elapsed(), r == state);
    if a.len() > 3 { let p = std::path::Path::new(&a[3]).join("big"); println!("{:?}", atomic::write(&p, &vec![1; 5 << 20])); println!("{:?}", atomic::write(std::path::Path::new("/proc/x"), b"1").map_err(|e| e.to_string())); }
}
