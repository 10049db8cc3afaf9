//! The rules of admission: which pages may connect, and with which first message.

use yoro_stream::{FromClient, Refusal, Token, VERSION};

/// Decides who may see the stream.
pub struct Access {
    pub token: Token,
    /// `http` or `https`.
    pub scheme: &'static str,
    /// The host names under which browsers reach this server.
    pub hosts: Vec<String>,
    /// The origin of another server whose page may also show the stream.
    pub origin: Option<String>,
}

impl Access {
    /// True if a page may connect: the requested host must be this server's, and the origin this server or the allowed
    /// one. This keeps out other sites' pages, even if their names are made to resolve to this machine.
    pub fn allows(&self, host: &str, origin: Option<&str>) -> bool {
        let is_own = || origin == Some(&format!("{}://{host}", self.scheme));
        let is_named = || origin.is_some() && origin == self.origin.as_deref();
        self.hosts.iter().any(|name| name == host) && (is_own() || is_named())
    }

    /// Returns whether a client may be served by its first message; `None` if that is no hello.
    pub fn judge(&self, hello: &[u8]) -> Option<Result<(), Refusal>> {
        let Some(FromClient::Hello { version, token }) = FromClient::read(hello) else { return None };
        // The comparison takes constant time, so that it reveals nothing about the token.
        let differs = token.iter().zip(&self.token).fold(0, |differs, (a, b)| differs | (a ^ b));
        Some(if version != VERSION {
            Err(Refusal::Version)
        } else if differs != 0 {
            Err(Refusal::Token)
        } else {
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn access() -> Access {
        Access {
            token: [7; 16],
            scheme: "https",
            hosts: vec!["10.0.0.1:80".to_owned()],
            origin: Some("https://host".to_owned()),
        }
    }

    #[test]
    fn pages_of_this_server_and_of_the_named_origin_may_connect() {
        for (host, origin, allowed) in [
            ("10.0.0.1:80", Some("https://10.0.0.1:80"), true),
            ("10.0.0.1:80", Some("https://host"), true),
            ("10.0.0.1:80", Some("http://10.0.0.1:80"), false),
            ("10.0.0.1:80", Some("https://host.example"), false),
            ("10.0.0.1:80", None, false),
            ("elsewhere", Some("https://host"), false),
            ("elsewhere", Some("https://elsewhere"), false),
        ] {
            assert_eq!(access().allows(host, origin), allowed, "{host}, {origin:?}");
        }
    }

    #[test]
    fn the_first_message_has_the_version_and_the_whole_token() {
        let judge = |message: FromClient| access().judge(&message.to_bytes());
        let hello = |version, token| judge(FromClient::Hello { version, token });
        assert_eq!(hello(VERSION, [7; 16]), Some(Ok(())));
        assert_eq!(hello(VERSION + 1, [7; 16]), Some(Err(Refusal::Version)));
        for wrong in [0, 15] {
            let mut token = [7; 16];
            token[wrong] ^= 1;
            assert_eq!(hello(VERSION, token), Some(Err(Refusal::Token)));
        }
        assert_eq!(judge(FromClient::Decoded(0)), None);
        assert_eq!(access().judge(b""), None);
    }
}
