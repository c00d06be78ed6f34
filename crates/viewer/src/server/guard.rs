//! Access to the viewer: with the token, and from a page of the viewer itself.

use super::error::ViewerError;

/// The secret part of the viewer's address: 128 random bits.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Token(String);

impl Token {
    pub(crate) fn random() -> Result<Self, ViewerError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(ViewerError::Token)?;
        Ok(Self(peristalsis_formats::hexadecimal(&bytes)))
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether the token is this one, in the same time wherever they differ.
    pub(crate) fn is(&self, given: &str) -> bool {
        let pairs = self.0.bytes().zip(given.bytes());
        let difference = pairs.fold(0, |sum, (one, other)| sum | (one ^ other));
        given.len() == self.0.len() && difference == 0
    }
}

/// Whether a request names this machine as its host. This refuses pages elsewhere whose name resolves to loopback.
pub(crate) fn is_loopback(host: Option<&str>) -> bool {
    let Some(host) = host else { return false };
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    ["127.0.0.1", "localhost", "[::1]"].contains(&name)
}

/// Whether a request comes from a page of this server, or from no page at all.
pub(crate) fn is_own(origin: Option<&str>, host: &str) -> bool {
    origin.is_none_or(|origin| origin.strip_prefix("http://") == Some(host))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_random_and_only_itself() {
        let (one, other) = (Token::random().unwrap(), Token::random().unwrap());
        assert!(one.is(one.as_str()) && !one.is(other.as_str()));
        assert_eq!(one.as_str().len(), 32);
        assert!(!one.is("") && !one.is(&one.as_str()[1..]));
        assert!(!one.is(&format!("{}0", one.as_str())));
    }

    #[test]
    fn hosts_and_origins() {
        for host in ["127.0.0.1:8000", "localhost:1", "localhost", "[::1]:80"] {
            assert!(is_loopback(Some(host)), "{host}");
            assert!(is_own(None, host) && is_own(Some(&format!("http://{host}")), host));
        }
        for host in [
            "evil.example",
            "127.0.0.1.evil.example:80",
            "",
            "localhost.evil:1",
        ] {
            assert!(!is_loopback(Some(host)), "{host}");
        }
        assert!(!is_loopback(None));
        for origin in [
            "null",
            "http://evil.example",
            "https://localhost:1",
            "http://localhost:2",
        ] {
            assert!(!is_own(Some(origin), "localhost:1"), "{origin}");
        }
    }
}
