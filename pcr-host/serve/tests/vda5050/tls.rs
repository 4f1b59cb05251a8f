//! Brokers over TLS, with certificates of the test's own.

use crate::broker::{Mosquitto, folder};
use crate::runs::{FAIR, first};
use crate::site::{Desk, Site};
use pcr_serve::journal_entry::NullStore;
use pcr_serve::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use std::path::{Path, PathBuf};
use std::process::Command;

fn openssl(folder: &Path, words: &str) {
    let mut command = Command::new("openssl");
    command.current_dir(folder).args(words.split(' '));
    let made = command.output().expect("openssl is needed: .ci/install.sh openssl");
    assert!(made.status.success(), "openssl {words}: {}", String::from_utf8_lossy(&made.stderr));
}

const KEY: &str = "-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes";

/// The certificate of somebody who signs others.
pub(crate) fn authority(folder: &Path, name: &str) -> PathBuf {
    openssl(folder, &format!("req -x509 {KEY} -keyout {name}.key -out {name}.pem -subj /CN={name} -days 2"));
    folder.join(format!("{name}.pem"))
}

/// A certificate for 127.0.0.1 that was signed by an authority in the same folder, and its key.
pub(crate) fn certificate(folder: &Path, authority: &str) -> [PathBuf; 2] {
    std::fs::write(folder.join("names"), "subjectAltName=IP:127.0.0.1\n").unwrap();
    openssl(folder, &format!("req {KEY} -keyout broker.key -out broker.csr -subj /CN=broker"));
    let signer = format!("-CA {authority}.pem -CAkey {authority}.key -CAcreateserial");
    openssl(folder, &format!("x509 -req -in broker.csr {signer} -out broker.pem -days 2 -extfile names"));
    let made = ["broker.pem", "broker.key"].map(|name| folder.join(name));
    for file in &made {
        // The broker gives up the rights of root, which has written the files.
        std::fs::set_permissions(file, std::os::unix::fs::PermissionsExt::from_mode(0o644)).unwrap();
    }
    made
}

#[test]
#[ignore = "needs a broker and openssl: .ci/test.sh tls"]
fn a_broker_is_believed_only_with_the_certificate_of_its_authority() {
    let mosquitto = Mosquitto::secured("secured", "pcr", "secret");
    let broker = mosquitto.address();
    assert_eq!(first(&broker), LinkEvent::Up);
    let is_down = |broker: &BrokerAddress, because: &str| {
        let said = first(broker);
        assert!(matches!(&said, LinkEvent::Down(why) if why.contains(because)), "{because}: {said:?}");
    };
    let other = authority(&folder("stranger"), "stranger");
    is_down(&BrokerAddress { authority: Some(other), ..broker.clone() }, "UnknownIssuer");
    // The certificate is for the address, not for the name.
    is_down(&BrokerAddress { host: "localhost".into(), ..broker.clone() }, "not valid for name");
    is_down(&BrokerAddress { login: Some(("pcr".into(), "guess".into())), ..broker.clone() }, "NotAuthorized");
    is_down(&BrokerAddress { authority: None, ..broker.clone() }, "");
}

#[test]
fn a_file_without_a_certificate_is_refused_before_anything_is_sent() {
    let folder = folder("nothing");
    let refused = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        let broker = BrokerAddress { authority: Some(folder.join(name)), ..BrokerAddress::new("127.0.0.1", 1) };
        MqttLink::open(&broker, "who", None, Vec::new(), drop).unwrap_err().to_string()
    };
    assert!(refused("empty.pem", "").contains("no certificate"));
    assert!(
        refused("key.pem", "-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\n").contains("no certificate")
    );
    let cut = refused("cut.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n");
    assert!(cut.contains("cut.pem: "), "{cut}");
    let wrong = refused("wrong.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n");
    assert!(wrong.contains("wrong.pem: "), "{wrong}");
}

#[test]
#[ignore = "needs a broker and openssl: .ci/test.sh tls"]
fn vehicles_do_their_missions_over_tls() {
    let broker = Mosquitto::secured("secured-two", "pcr", "secret");
    let (mut site, profiles) = Site::open(&broker, FAIR);
    let desk = Desk::open(&broker, profiles, "secured", Box::new(NullStore));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(1)));
    assert!(told.is_ok(), "{}", desk.tell());
    site.close();
    desk.close().unwrap();
}
