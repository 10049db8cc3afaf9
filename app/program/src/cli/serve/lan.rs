//! Reachability in the local network: an address, a certificate for it, and a code for cameras.

use std::fs::{self, DirBuilder};
use std::io::Write as _;
use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::os::unix::fs::{DirBuilderExt as _, MetadataExt as _, PermissionsExt as _};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use anyhow::{Context as _, bail, ensure};
use qrcode::QrCode;
use qrcode::render::unicode::Dense1x2;
use rcgen::{CertificateParams, DnType, ExtendedKeyUsagePurpose, KeyPair, SanType};
use rustls::ServerConfig;
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use yoro_files::xdg;

const DAY: Duration = Duration::from_secs(24 * 60 * 60);
/// The number of days for which a certificate is valid. Apple's browsers refuse more than 825.
const VALID: u32 = 397;
/// The number of days for which it is used.
const USED: u32 = 365;

/// The address and the encryption of a server in the local network.
pub struct Lan {
    pub address: IpAddr,
    pub tls: Arc<ServerConfig>,
    /// SHA-256 of the certificate, formatted as in browsers.
    pub fingerprint: String,
}

impl Lan {
    /// Uses the given address, or else that of the default route, with an existing certificate for it or a new one.
    ///
    /// # Errors
    /// One sentence, if there is no such address, or no place to keep the certificate.
    pub fn new(named: Option<IpAddr>) -> anyhow::Result<Lan> {
        let address = match named {
            Some(address) => address,
            None => own_address().context(
                "this machine is in no network: connect it, or name one of its addresses with --lan=ADDRESS",
            )?,
        };
        if let IpAddr::V6(v6) = address {
            ensure!(
                !v6.is_unicast_link_local(),
                "{address} is valid on one link alone, and browsers do not open such addresses: name another address \
                 with --lan=ADDRESS"
            );
        }
        ensure!(
            is_local(address),
            "{address} is open to the internet, where nothing is served: name an address of a local network \
             with --lan=ADDRESS"
        );
        let folder = xdg::folder("XDG_STATE_HOME", ".local/state")
            .context("neither XDG_STATE_HOME nor HOME is an absolute path; set one of them")?
            .join("yoro/serve");
        let pem = certificate(&folder, address, VALID)?;
        Ok(Lan { address, tls: Arc::new(configure(&pem)?), fingerprint: fingerprint(&pem)? })
    }
}

/// Returns the address of the interface through which this machine reaches others. This sends nothing.
fn own_address() -> Option<IpAddr> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    // The address is reserved for documentation.
    socket.connect((Ipv4Addr::new(192, 0, 2, 1), 9)).ok()?;
    Some(socket.local_addr().ok()?.ip()).filter(|address| !address.is_loopback())
}

/// True for addresses that cannot be reached from the internet: private, link-local and loopback addresses, and those
/// that providers and overlay networks share (100.64.0.0/10).
fn is_local(address: IpAddr) -> bool {
    match address {
        IpAddr::V4(v4) => {
            let is_shared = v4.octets()[0] == 100 && v4.octets()[1] & 0xc0 == 64;
            v4.is_private() || v4.is_link_local() || v4.is_loopback() || is_shared
        }
        IpAddr::V6(v6) => v6.is_unique_local() || v6.is_loopback(),
    }
}

/// Returns key and certificate for an address: those kept in the folder, or new ones, which are stored there. Only this
/// user may read the key.
fn certificate(folder: &Path, address: IpAddr, valid: u32) -> anyhow::Result<Vec<u8>> {
    let unusable = || format!("{} cannot be used for the server's key", folder.display());
    DirBuilder::new().recursive(true).mode(0o700).create(folder).with_context(unusable)?;
    // A new file belongs to this user and nobody else can read it.
    let mut new = tempfile::NamedTempFile::new_in(folder).with_context(unusable)?;
    let user = new.as_file().metadata()?.uid();
    ensure!(
        fs::metadata(folder)?.uid() == user,
        "{} belongs to another user, who could read the server's key: remove it, or set XDG_STATE_HOME to a folder of \
         your own",
        folder.display()
    );
    fs::set_permissions(folder, fs::Permissions::from_mode(0o700)).with_context(unusable)?;
    let path = folder.join(format!("{address}.pem"));
    // A link, or what another user has written or read, is replaced.
    let is_own = fs::symlink_metadata(&path)
        .is_ok_and(|data| data.is_file() && data.uid() == user && data.mode() & 0o077 == 0);
    if is_own
        && let Ok(pem) = fs::read(&path)
        && configure(&pem).is_ok()
        && is_fresh(&pem)
    {
        return Ok(pem);
    }
    let key = KeyPair::generate()?;
    let mut params = CertificateParams::default();
    params.distinguished_name.push(DnType::CommonName, "yoro serve");
    params.subject_alt_names = vec![SanType::IpAddress(address)];
    params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth];
    let now = SystemTime::now();
    // The certificate is valid from yesterday on, because clocks differ.
    params.not_before = (now - DAY).into();
    params.not_after = (now + (valid - 1) * DAY).into();
    let pem = [key.serialize_pem(), params.self_signed(&key)?.pem()].concat().into_bytes();
    new.write_all(&pem).and_then(|()| new.as_file().sync_all()).with_context(unusable)?;
    new.persist(&path).map_err(|error| error.error).with_context(unusable)?;
    Ok(pem)
}

/// True if a certificate is valid now, and will be for a while.
fn is_fresh(pem: &[u8]) -> bool {
    let Ok(der) = CertificateDer::from_pem_slice(pem) else { return false };
    let Ok((_, certificate)) = x509_parser::parse_x509_certificate(&der) else { return false };
    let left = certificate.validity().time_to_expiration();
    let needed = (VALID - 1 - USED) * DAY;
    left.is_some_and(|left| left.whole_seconds() > needed.as_secs() as i64)
}

/// Returns the encryption of connections with this key and certificate: TLS 1.3, which every browser
/// supports that lets pages decode video.
fn configure(pem: &[u8]) -> anyhow::Result<ServerConfig> {
    let (Ok(key), Ok(certificate)) =
        (PrivateKeyDer::from_pem_slice(pem), CertificateDer::from_pem_slice(pem))
    else {
        bail!("there is no key with a certificate");
    };
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let mut config = ServerConfig::builder_with_provider(provider)
        .with_protocol_versions(&[&rustls::version::TLS13])?
        .with_no_client_auth()
        .with_single_cert(vec![certificate], key)?;
    config.alpn_protocols = vec![b"http/1.1".to_vec()];
    Ok(config)
}

/// Returns the SHA-256 of a certificate, formatted as in browsers.
fn fingerprint(pem: &[u8]) -> anyhow::Result<String> {
    let certificate = CertificateDer::from_pem_slice(pem).context("the certificate cannot be read")?;
    let hash = ring::digest::digest(&ring::digest::SHA256, &certificate);
    Ok(hash.as_ref().iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(":"))
}

/// Returns a text as a QR code for terminals, black on white in any colour scheme.
///
/// # Errors
/// If the text is too long.
pub fn code(text: &str) -> anyhow::Result<String> {
    let code = QrCode::new(text)?.render::<Dense1x2>().build();
    Ok(code.lines().map(|line| format!("\x1b[30;107m{line}\x1b[0m\n")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_addresses_of_local_networks_are_served() {
        let local = |text: &str| is_local(text.parse().unwrap());
        let own = "192.168.1.5 10.0.0.1 172.16.3.4 169.254.1.1 127.0.0.2 100.100.1.1 fd00::5 ::1";
        assert!(own.split(' ').all(local));
        let public = "8.8.8.8 172.32.0.1 100.128.0.1 0.0.0.0 2001:db8::1 fe80::1 ::";
        assert!(!public.split(' ').any(local));
        let refused = Lan::new(Some("8.8.8.8".parse().unwrap())).err().unwrap().to_string();
        assert!(refused.contains("--lan=ADDRESS"), "{refused}");
    }

    #[test]
    fn a_certificate_is_kept_for_its_address_alone_until_it_is_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("serve");
        let [here, there] = [[10, 0, 0, 1], [10, 0, 0, 2]].map(|octets: [u8; 4]| IpAddr::from(octets));
        let first = certificate(&folder, here, VALID).unwrap();
        assert_eq!(fs::metadata(&folder).unwrap().permissions().mode() & 0o077, 0, "others read the key");
        assert_eq!(certificate(&folder, here, VALID).unwrap(), first);
        let file = folder.join("10.0.0.1.pem");
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing else is left");
        assert_ne!(certificate(&folder, there, VALID).unwrap(), first);
        fs::write(&file, &first[..first.len() / 2]).unwrap();
        let whole = certificate(&folder, here, VALID).unwrap();
        assert!(whole != first && configure(&whole).is_ok());
        // What others can read, and what lies elsewhere, is replaced; the file elsewhere is not.
        fs::set_permissions(&file, fs::Permissions::from_mode(0o644)).unwrap();
        let new = certificate(&folder, here, VALID).unwrap();
        assert!(new != whole && fs::metadata(&file).unwrap().mode() & 0o777 == 0o600);
        let elsewhere = folder.with_file_name("elsewhere.pem");
        fs::rename(&file, &elsewhere).unwrap();
        std::os::unix::fs::symlink(&elsewhere, &file).unwrap();
        assert_ne!(certificate(&folder, here, VALID).unwrap(), new);
        assert_eq!(fs::read(&elsewhere).unwrap(), new);
    }

    #[test]
    fn a_certificate_is_used_as_long_as_it_says() {
        let dir = tempfile::tempdir().unwrap();
        let here = IpAddr::from([10, 0, 0, 1]);
        // Copies have any time of change.
        let pem = certificate(dir.path(), here, VALID - USED).unwrap();
        assert!(!is_fresh(&pem) && !is_fresh(b"none"));
        let new = certificate(dir.path(), here, VALID).unwrap();
        assert!(new != pem && is_fresh(&new));
    }

    #[test]
    fn a_camera_reads_the_code_of_a_link() {
        let link =
            "https://192.168.178.20:8080/#stream=0123456789abcdef0123456789abcdef&display=side-by-side";
        let text = code(link).unwrap();
        let rows: Vec<&str> = text
            .lines()
            .map(|line| line.trim_start_matches("\x1b[30;107m").trim_end_matches("\x1b[0m"))
            .collect();
        // A character shows two modules, one above the other.
        let side = 4;
        let width = rows[0].chars().count() * side;
        let mut luma = Vec::new();
        for row in &rows {
            for half in ['▀', '▄'] {
                let is_dark = |letter| letter == '█' || letter == half;
                let line: Vec<u8> =
                    row.chars().flat_map(|letter| [if is_dark(letter) { 0 } else { 255 }; 4]).collect();
                (0..side).for_each(|_| luma.extend(&line));
            }
        }
        assert_eq!(yoro_lenses::read_qr_in_luma(&luma, width).as_deref(), Some(link));
    }
}
