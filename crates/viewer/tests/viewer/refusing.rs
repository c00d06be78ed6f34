//! What strangers and broken clients get.

use std::io::Write;

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
