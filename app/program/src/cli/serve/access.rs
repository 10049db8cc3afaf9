//! The rules of admission: which pages may connect, and with which first message.

use yoro_stream::{FromClient, Refusal, Token, VERSION};

/// Decides who may see the stream.
pub struct Access {
    pub token: Token,
    /// `http` or `https`.
    pub scheme: &'static str,
    /// The host names under which browsers reach this server, in the form of [`host`].
    pub hosts: Vec<String>,
}

impl Access {
    /// True if a page may connect: the requested host and the page's origin must be this server's. This keeps out other
    /// sites' pages, even if their names are made to resolve to this machine.
    pub fn allows(&self, host: &str, origin: Option<&str>) -> bool {
        let host = self::host(self.scheme, host);
        let is_own = |origin: &str| {
            origin
                .strip_prefix(self.scheme)
                .and_then(|rest| rest.strip_prefix("://"))
                .is_some_and(|from| self::host(self.scheme, from) == host)
        };
        self.hosts.iter().any(|name| name == host) && origin.is_some_and(is_own)
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

/// Returns a host with its port as browsers name it: they leave out the scheme's own port.
pub fn host<'a>(scheme: &str, host: &'a str) -> &'a str {
    let port = if scheme == "https" { ":443" } else { ":80" };
    host.strip_suffix(port).unwrap_or(host)
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_stream::Report;

    fn access() -> Access {
        Access { token: [7; 16], scheme: "https", hosts: vec!["10.0.0.1:80".to_owned()] }
    }

    #[test]
    fn pages_of_this_server_may_connect() {
        for (host, origin, allowed) in [
            ("10.0.0.1:80", Some("https://10.0.0.1:80"), true),
            ("10.0.0.1:80", Some("http://10.0.0.1:80"), false),
            ("10.0.0.1:80", Some("https://host.example"), false),
            ("10.0.0.1:80", None, false),
            ("elsewhere", Some("https://elsewhere"), false),
        ] {
            assert_eq!(access().allows(host, origin), allowed, "{host}, {origin:?}");
        }
    }

    #[test]
    fn browsers_leave_out_the_default_port() {
        let allows = |scheme: &'static str, host: &str, origin: &str| {
            let hosts = vec![super::host(scheme, host).to_owned()];
            let access = Access { scheme, hosts, ..access() };
            let named = host.rsplit_once(':').unwrap().0;
            [host, named].iter().all(|asked| access.allows(asked, Some(origin)))
        };
        assert!(allows("http", "127.0.0.1:80", "http://127.0.0.1"));
        assert!(allows("https", "10.0.0.1:443", "https://10.0.0.1"));
        assert!(allows("https", "10.0.0.1:443", "https://10.0.0.1:443"));
        assert!(!allows("http", "127.0.0.1:443", "http://127.0.0.1"));
        assert!(!allows("https", "10.0.0.1:443", "http://10.0.0.1"));
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
        assert_eq!(judge(FromClient::Report(Report::default())), None);
        assert_eq!(access().judge(b""), None);
    }
}
