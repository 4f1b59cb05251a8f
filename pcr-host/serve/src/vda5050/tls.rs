//! Connections to brokers over TLS, 1.2 or 1.3.

use crate::setup_error::SetupError;
use rumqttc::{TlsConfiguration, Transport};
use std::path::Path;
use std::sync::Arc;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::CertificateDer;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::{ClientConfig, RootCertStore};

/// To brokers whose certificate is signed by one of those in a file (PEM), and by nobody else.
///
/// # Errors
/// The problem with the file.
pub(super) fn transport(authority: &Path) -> Result<Transport, SetupError> {
    let wrong = |why: &dyn std::fmt::Display| SetupError::Authority { file: authority.into(), why: why.to_string() };
    let bytes = std::fs::read(authority).map_err(|error| wrong(&error))?;
    let mut roots = RootCertStore::empty();
    for certificate in CertificateDer::pem_slice_iter(&bytes) {
        roots.add(certificate.map_err(|error| wrong(&error))?).map_err(|error| wrong(&error))?;
    }
    if roots.is_empty() {
        return Err(wrong(&"there is no certificate (PEM) in it"));
    }
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()));
    let config = config.with_safe_default_protocol_versions().map_err(|error| wrong(&error))?;
    let config = config.with_root_certificates(roots).with_no_client_auth();
    Ok(Transport::Tls(TlsConfiguration::Rustls(Arc::new(config))))
}
