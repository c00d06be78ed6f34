//! What strangers and broken clients get.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use tokio_tungstenite::tungstenite::Message;

use crate::client::Served;

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or("nothing")
}

#[test]
fn the_page_is_for_those_who_know_the_token() {
    let served = Served::small();
    let base = &served.base;
    let host = served.host();
    for (name, kind) in [
        ("", "text/html"),
        ("viewer.js", "text/javascript"),
        ("viewer.css", "text/css"),
    ] {
        let answer = served.get(&format!("{base}{name}"), &[&host]);
        assert_eq!(status(&answer), "200", "{name}");
        assert!(answer.contains(&format!("content-type: {kind}")), "{name}");
        let security = "content-security-policy: default-src 'none'; script-src 'self'";
        assert!(answer.contains(security) && answer.contains("referrer-policy: no-referrer"));
        assert!(answer.len() > 1000, "{name} is {} bytes", answer.len());
    }
    let other = base.replace(|it: char| it.is_ascii_digit(), "f");
    for path in [
        "/",
        "/viewer.js",
        "//",
        &other,
        &format!("{other}viewer.js"),
        &base[..base.len() - 2],
    ] {
        assert_eq!(status(&served.get(path, &[&host])), "404", "{path}");
    }
    assert_eq!(
        served.upgrade(&format!("{other}live"), None).err(),
        Some(404)
    );
}

#[test]
fn other_hosts_and_origins_are_refused() {
    let served = Served::small();
    let base = &served.base;
    for host in [
        "Host: evil.example",
        "Host: 127.0.0.1.evil.example:80",
        "Host: 10.0.0.1",
    ] {
        assert_eq!(status(&served.get(base, &[host])), "403", "{host}");
    }
    assert_ne!(status(&served.get(base, &[])), "200");
    let live = format!("{base}live");
    for origin in [
        "http://evil.example",
        "null",
        "https://127.0.0.1",
        "http://localhost:1",
    ] {
        let line = format!("Origin: {origin}");
        assert_eq!(status(&served.get(base, &[&served.host(), &line])), "403");
        assert_eq!(
            served.upgrade(&live, Some(origin)).err(),
            Some(403),
            "{origin}"
        );
    }
    let own = format!("http://127.0.0.1:{}", served.port);
    assert!(served.upgrade(&live, Some(&own)).is_ok());
    // Through a tunnel the port is another, and so are both.
    let tunnel = ["Host: localhost:9000", "Origin: http://localhost:9000"];
    assert_eq!(status(&served.get(base, &tunnel)), "200");
}

#[test]
fn no_path_leads_out_of_the_page() {
    let served = Served::small();
    let (base, host) = (&served.base, served.host());
    for path in [
        "../Cargo.toml",
        "../../etc/passwd",
        "%2e%2e/%2e%2e/etc/passwd",
        "..%2f..%2fetc%2fpasswd",
        "%2fetc%2fpasswd",
        "viewer.js/../../Cargo.toml",
        "viewer.js%00.css",
        "assets/viewer.js",
        "index.html",
    ] {
        let answer = served.get(&format!("{base}{path}"), &[&host]);
        assert_eq!(status(&answer), "404", "{path}");
        assert!(answer.ends_with("\r\n\r\n"), "{path}: {answer}");
    }
}

#[test]
fn malformed_messages_are_answered_and_end_the_connection() {
    let served = Served::small();
    for text in [
        "",
        "play",
        "{\"type\":\"quit\"}",
        "{\"type\":\"seek\",\"period\":-1}",
        "[[[[[[",
    ] {
        let (mut client, _) = served.client();
        client.send(text);
        assert_eq!(client.notice()["type"], "problem", "{text}");
        assert!(client.next().is_none(), "{text}");
    }
    let deep = "[".repeat(4000);
    let long = format!("{{\"type\":\"save\",\"pad\":\"{}\"}}", "x".repeat(5000));
    for message in [
        Message::binary(vec![0; 16]),
        Message::text(deep),
        Message::text(long),
        Message::binary(vec![0; 1 << 20]),
    ] {
        let (mut client, _) = served.client();
        client.send_message(message);
        // Frames and the reason may come first.
        let mut left = 20;
        while client.next().is_some() {
            left -= 1;
            assert!(left > 0, "the connection goes on");
        }
    }
    // Bytes that are no WebSocket, and no HTTP.
    served.connect().write_all(&[0xff; 4096]).unwrap();
    // The next client is served as if nothing had been.
    let (mut client, _) = served.client();
    client.send(r#"{"type":"play","playing":true}"#);
    client.frame_with(|head| head["clock"].as_f64().unwrap() > 0.05);
}

#[test]
fn a_ninth_client_waits_for_a_place() {
    let served = Served::small();
    let live = format!("{}live", served.base);
    let mut clients: Vec<_> = (0..8).map(|_| served.client()).collect();
    assert_eq!(served.upgrade(&live, None).err(), Some(503));
    clients.pop();
    let mut refused = 0;
    while served.upgrade(&live, None).is_err() {
        refused += 1;
        assert!(refused < 500, "the place is not given back");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}

#[test]
fn a_flood_of_commands_waits_and_does_no_harm() {
    let served = Served::small();
    let (mut client, _) = served.client();
    for _ in 0..2000 {
        client.send(r#"{"type":"steer","parameter":"width","value":2.7}"#);
    }
    client.send(r#"{"type":"play","playing":true}"#);
    let (mut other, _) = served.client();
    other.send(r#"{"type":"play","playing":true}"#);
    other.frame_with(|head| head["clock"].as_f64().unwrap() > 0.05);
}

/// What comes until the server ends the connection.
fn rest(mut stream: TcpStream) -> String {
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        Ok(_) => {}
        // It ended the connection while bytes were on their way to it.
        Err(error) if error.kind() == ErrorKind::ConnectionReset => {}
        Err(error) => panic!("the server goes on: {error}"),
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// What comes in answer to these bytes until the server ends the connection.
fn answer(served: &Served, bytes: &[u8]) -> String {
    let mut stream = served.connect();
    // The server may end it before everything has arrived.
    drop(stream.write_all(bytes));
    rest(stream)
}

#[test]
fn who_is_slow_to_say_what_he_wants_is_left_alone_and_keeps_nobody_out() {
    let served = Served::small();
    let begin = Instant::now();
    // More of them than there are places, some of which say nothing at all.
    let slow: Vec<TcpStream> = (0..80)
        .map(|number| {
            let mut stream = served.connect();
            if number % 2 == 0 {
                let head = format!("GET {} HTTP/1.1\r\nHost: 127", served.base);
                stream.write_all(head.as_bytes()).unwrap();
            }
            stream
        })
        .collect();
    let page = served.get(&served.base, &[&served.host()]);
    assert_eq!(status(&page), "200");
    for stream in slow.into_iter().take(8) {
        assert!(!rest(stream).contains("200 OK"));
    }
    assert!(
        begin.elapsed() < Duration::from_secs(25),
        "{:?}",
        begin.elapsed()
    );
}

#[test]
fn requests_are_short_and_one_is_one() {
    let served = Served::small();
    let (base, host) = (&served.base, served.host());
    let long = "x".repeat(1 << 20);
    let many: String = (0..400)
        .map(|number| format!("X-{number}: 1\r\n"))
        .collect();
    let evil = "Host: evil.example";
    let refused = [
        format!("GET /{long} HTTP/1.1\r\n{host}\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{host}\r\nX: {long}\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{many}{host}\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{host}\r\n{evil}\r\nConnection: close\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{evil}\r\n{host}\r\nConnection: close\r\n\r\n"),
        format!(
            "GET {base} HTTP/1.1\r\n{host}\r\nOrigin: http://evil.example\r\nOrigin: http://{}\r\nConnection: close\r\n\r\n",
            &host[6..]
        ),
        format!("GET {base} HTTP/1.1\r\n{host}\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{host}\r\nContent-Length: -1\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{host}\r\nTransfer-Encoding: gzip\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\n{host}\r\n folded: yes\r\nConnection: close\r\n\r\n"),
        format!("GET {base} HTTP/1.1\r\nHo\0st: 127.0.0.1\r\n\r\n"),
        format!("GET {base} HTTP/9.9\r\n{host}\r\n\r\n"),
        format!("GET {base}\r\n\r\n"),
        format!(
            "POST {base} HTTP/1.1\r\n{host}\r\nConnection: close\r\nContent-Length: 2\r\n\r\n{{}}"
        ),
        format!("DELETE {base}viewer.js HTTP/1.1\r\n{host}\r\nConnection: close\r\n\r\n"),
        format!("CONNECT 127.0.0.1:80 HTTP/1.1\r\n{host}\r\nConnection: close\r\n\r\n"),
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_owned(),
        "\0".repeat(100_000),
    ];
    for request in &refused {
        let answer = answer(&served, request.as_bytes());
        let begin = &request[..request.len().min(300)];
        assert!(!answer.contains("200 OK"), "{begin:?}: {answer}");
        assert!(!answer.contains("<html"), "{begin:?}");
    }
    // What is in a body is no request; what follows a whole request is one, and is judged by itself.
    let other = format!("GET {base} HTTP/1.1\r\n{evil}\r\nConnection: close\r\n\r\n");
    let within = format!(
        "GET {base} HTTP/1.1\r\n{host}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n{other}",
        other.len()
    );
    let after = format!("GET {base} HTTP/1.1\r\n{host}\r\n\r\n{other}");
    for (request, statuses) in [(within, &["200"][..]), (after, &["200", "403"])] {
        let answer = answer(&served, request.as_bytes());
        let found: Vec<&str> = answer
            .split("HTTP/1.1 ")
            .skip(1)
            .map(|it| &it[..3])
            .collect();
        assert_eq!(found, statuses);
    }
    served.client();
}

/// A WebSocket that is spoken by hand; waits until the server has a place for one more client.
#[allow(clippy::unwrap_used, reason = "what is missing fails the test")]
fn by_hand(served: &Served) -> TcpStream {
    let request = format!(
        "GET {}live HTTP/1.1\r\n{}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
        served.base,
        served.host()
    );
    for _ in 0..500 {
        let mut stream = served.connect();
        stream
            .write_all(request.as_bytes())
            .expect("the server takes a request");
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).expect("the server answers");
            head.push(byte[0]);
        }
        if head.starts_with(b"HTTP/1.1 101") {
            return stream;
        }
        assert!(head.starts_with(b"HTTP/1.1 503"));
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("no place is given back")
}

/// A frame of a WebSocket whose mask changes nothing.
fn masked(first: u8, payload: &[u8]) -> Vec<u8> {
    let mut frame = vec![first];
    match payload.len() {
        length @ 0..=125 => frame.push(0x80 | length as u8),
        length => {
            frame.push(0x80 | 126);
            frame.extend((length as u16).to_be_bytes());
        }
    }
    frame.extend([0; 4]);
    frame.extend(payload);
    frame
}

#[test]
fn frames_that_are_none_end_the_connection() {
    let served = Served::small();
    let mut endless = masked(0x01, &[b'x'; 1000]);
    for _ in 0..20 {
        endless.extend(masked(0x00, &[b'x'; 1000]));
    }
    // A length of 2^63 - 1, and the mask.
    let huge = [&[0x81, 0xff, 0x7f][..], &[0xff; 7], &[0; 4]].concat();
    let wrong: [(&str, Vec<u8>); 9] = [
        ("not masked", vec![0x81, 0x02, b'{', b'}']),
        ("reserved bits", masked(0xf1, b"{}")),
        ("an unknown kind", masked(0x83, b"{}")),
        ("2^63 bytes", huge),
        ("pieces without end", endless),
        ("a piece of nothing", masked(0x80, b"{}")),
        ("no text", masked(0x81, &[0xff, 0xfe])),
        ("a long ping", masked(0x89, &[0; 200])),
        ("a ping in pieces", masked(0x09, b"{}")),
    ];
    for (name, bytes) in wrong {
        let mut stream = by_hand(&served);
        drop(stream.write_all(&bytes));
        let said = rest(stream);
        assert!(
            said.contains("welcome") || said.is_empty(),
            "{name}: {said}"
        );
    }
    served.client();
}

#[test]
fn no_bytes_bring_the_server_down() {
    let served = Served::small();
    let mut state = 1_u64;
    let mut byte = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    };
    for number in 0..200 {
        let length = 1 + usize::from(byte());
        let bytes: Vec<u8> = (0..length).map(|_| byte()).collect();
        let mut stream = if number % 2 == 0 {
            by_hand(&served)
        } else {
            served.connect()
        };
        // Most are broken off at once, some in the middle of a frame.
        drop(stream.write_all(&bytes));
    }
    let (mut client, _) = served.client();
    client.send(r#"{"type":"play","playing":true}"#);
    client.frame_with(|head| head["clock"].as_f64().unwrap() > 0.05);
}
