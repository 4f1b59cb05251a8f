//! A real broker for a test: mosquitto.

use pcr_serve::vda5050::mqtt::BrokerAddress;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A broker that ends with the test.
pub(crate) struct Mosquitto {
    child: Child,
    folder: PathBuf,
    port: u16,
    login: Option<(String, String)>,
    authority: Option<PathBuf>,
}

/// A folder of this name that is empty, of this process.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

impl Mosquitto {
    pub(crate) fn start(name: &str) -> Self {
        Self::with(folder(&format!("broker-{name}")), "allow_anonymous true")
    }

    /// Which lets in a user with a password only.
    pub(crate) fn guarded(name: &str, user: &str, password: &str) -> Self {
        let folder = folder(&format!("broker-{name}"));
        let access = Self::passwords(&folder, &[[user, password]]);
        let mut broker = Self::with(folder, &access);
        broker.login = Some((user.into(), password.into()));
        broker
    }

    /// The same over TLS, with a certificate for this address that was made for it.
    #[cfg(feature = "tls")]
    pub(crate) fn secured(name: &str, user: &str, password: &str) -> Self {
        let folder = folder(&format!("broker-{name}"));
        let access = Self::passwords(&folder, &[[user, password]]);
        let authority = crate::tls::authority(&folder, "authority");
        let made = crate::tls::certificate(&folder, "authority");
        let [certificate, key] = made.each_ref().map(|file| file.display());
        let mut broker = Self::with(folder, &format!("{access}\ncertfile {certificate}\nkeyfile {key}"));
        (broker.login, broker.authority) = (Some((user.into(), password.into())), Some(authority));
        broker
    }

    /// With the files of `deploy`, and the rights of one more user.
    pub(crate) fn deployed(name: &str, users: &[[&str; 2]], more: &str) -> Self {
        let folder = folder(&format!("broker-{name}"));
        Self::passwords(&folder, users);
        std::fs::write(folder.join("mosquitto.acl"), crate::deploy_runs::file("mosquitto.acl") + more).unwrap();
        let config = crate::deploy_runs::file("mosquitto.conf");
        assert!(config.contains("\nlistener 1883\n") && config.contains(" /etc/mosquitto/"));
        let config = config.replace("/etc/mosquitto", folder.to_str().unwrap());
        Self::configured(folder, |port| config.replace("\nlistener 1883\n", &format!("\nlistener {port} 127.0.0.1\n")))
    }

    fn passwords(folder: &Path, users: &[[&str; 2]]) -> String {
        let file = folder.join("passwords");
        std::fs::write(&file, "").unwrap();
        for login in users {
            let made = Command::new("mosquitto_passwd").arg("-b").arg(&file).args(login).status();
            assert!(made.is_ok_and(|status| status.success()), "mosquitto_passwd comes with mosquitto");
        }
        // It gives up the rights of root, which has written the file.
        let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o644);
        std::fs::set_permissions(&file, permissions).unwrap();
        format!("allow_anonymous false\npassword_file {}", file.display())
    }

    fn with(folder: PathBuf, access: &str) -> Self {
        Self::configured(folder, |port| format!("listener {port} 127.0.0.1\nset_tcp_nodelay true\n{access}\n"))
    }

    fn configured(folder: PathBuf, config: impl FnOnce(u16) -> String) -> Self {
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        std::fs::write(folder.join("mosquitto.conf"), config(port) + "\nlog_dest none\n").unwrap();
        let child = Self::spawn(&folder);
        let broker = Self { child, folder, port, login: None, authority: None };
        broker.wait();
        broker
    }

    fn spawn(folder: &Path) -> Child {
        let path = format!("{}:/usr/sbin", std::env::var("PATH").unwrap_or_default());
        let mut command = Command::new("mosquitto");
        command.arg("-c").arg(folder.join("mosquitto.conf")).env("PATH", &path);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let child = command.spawn();
        // The search path that counts is that of this process.
        let child = child.or_else(|_| {
            Command::new("/usr/sbin/mosquitto")
                .arg("-c")
                .arg(folder.join("mosquitto.conf"))
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
        });
        child.expect("mosquitto is needed: .ci/install.sh mosquitto")
    }

    fn wait(&self) {
        while std::net::TcpStream::connect(("127.0.0.1", self.port)).is_err() {
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Ends it with all that it keeps, and starts another one at its place.
    pub(crate) fn restart(&mut self) {
        self.stop();
        std::thread::sleep(Duration::from_millis(300));
        self.begin();
    }

    /// Ends it with all that it keeps.
    pub(crate) fn stop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// Starts another one at its place.
    pub(crate) fn begin(&mut self) {
        self.child = Self::spawn(&self.folder);
        self.wait();
    }

    /// How to reach it, with all that it asks for.
    pub(crate) fn address(&self) -> BrokerAddress {
        let (login, authority) = (self.login.clone(), self.authority.clone());
        BrokerAddress { login, authority, ..BrokerAddress::new("127.0.0.1", self.port) }
    }
}

impl Drop for Mosquitto {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
