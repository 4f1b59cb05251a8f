//! A connection to a broker that comes back by itself.

use super::bridge::Publish;
use rumqttc::{Client, Event, LastWill, MqttOptions, Packet, QoS, RecvTimeoutError};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Where the broker is.
#[derive(Clone, Debug, PartialEq)]
pub struct Broker {
    /// Name or address.
    pub host: String,
    /// Usually 1883, with TLS 8883.
    pub port: u16,
    /// User and password.
    pub login: Option<(String, String)>,
    /// TLS, with the certificate (PEM) of who has signed the broker's.
    pub authority: Option<PathBuf>,
}

impl Broker {
    /// Without TLS and login.
    pub fn new(host: &str, port: u16) -> Self {
        Self { host: host.into(), port, login: None, authority: None }
    }
}

/// What comes from a broker.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// It is connected, and subscribed.
    Up,
    /// It is no longer, or not yet, and why.
    Down(String),
    /// A message.
    Message {
        /// Of this topic.
        topic: String,
        /// Bytes.
        payload: Vec<u8>,
    },
}

/// Packets that are larger are not read at all \[bytes\]: the connection ends, and comes back.
const LARGEST: usize = 1 << 20;

/// Messages that wait to be sent.
const QUEUE: usize = 4_096;

/// When nothing was sent for so long, the broker is asked whether it is there.
const KEEP_ALIVE: Duration = Duration::from_secs(5);

/// Between two attempts to connect.
const AGAIN: Duration = Duration::from_millis(200);

/// A connection. Dropped, it breaks without a word, as when power is lost: its last will is done.
pub struct Link {
    client: Client,
    stop: Arc<AtomicBool>,
    up: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl std::fmt::Debug for Link {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Link").field("up", &self.is_up()).finish_non_exhaustive()
    }
}

impl Link {
    /// Connects, again and again, and subscribes to these topics each time. What comes is given to `sink`, by a thread of its own.
    ///
    /// # Errors
    /// What is wrong with the settings, or that there is no thread for it.
    pub fn open(
        broker: &Broker,
        id: &str,
        will: Option<Publish>,
        filters: Vec<String>,
        sink: impl Fn(News) + Send + 'static,
    ) -> Result<Self, String> {
        let mut options = MqttOptions::new(id, &broker.host, broker.port);
        options.set_keep_alive(KEEP_ALIVE).set_max_packet_size(LARGEST, LARGEST).set_clean_session(true);
        if let Some((user, password)) = &broker.login {
            options.set_credentials(user, password);
        }
        if let Some(will) = will {
            options.set_last_will(LastWill::new(&will.topic, will.payload, qos(will.assured), will.retain));
        }
        secure(&mut options, broker)?;
        let (client, mut connection) = Client::new(options, QUEUE);
        let (stop, up) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        let (ended, is_up, subscriber) = (stop.clone(), up.clone(), client.clone());
        let work = move || {
            let mut waits = 0;
            while !ended.load(Ordering::Relaxed) {
                match connection.recv_timeout(Duration::from_millis(50)) {
                    Ok(Ok(Event::Incoming(Packet::ConnAck(_)))) => {
                        waits = filters.len();
                        for filter in &filters {
                            // The queue is as good as empty here; were it full, this would be tried again after a while.
                            if subscriber.try_subscribe(filter, QoS::AtLeastOnce).is_err() {
                                sink(News::Down("the queue is full".into()));
                            }
                        }
                        if waits == 0 {
                            is_up.store(true, Ordering::Relaxed);
                            sink(News::Up);
                        }
                    }
                    Ok(Ok(Event::Incoming(Packet::SubAck(_)))) if waits > 0 => {
                        waits -= 1;
                        if waits == 0 {
                            is_up.store(true, Ordering::Relaxed);
                            sink(News::Up);
                        }
                    }
                    Ok(Ok(Event::Incoming(Packet::Publish(message)))) => {
                        sink(News::Message { topic: message.topic, payload: message.payload.to_vec() });
                    }
                    Ok(Ok(_)) | Err(RecvTimeoutError::Timeout) => {}
                    Ok(Err(error)) => {
                        if is_up.swap(false, Ordering::Relaxed) {
                            sink(News::Down(error.to_string()));
                        }
                        std::thread::sleep(AGAIN);
                    }
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        };
        let thread = std::thread::Builder::new().name(id.into()).spawn(work).map_err(|error| error.to_string())?;
        Ok(Self { client, stop, up, thread: Some(thread) })
    }

    /// Whether it is connected, as far as is known.
    pub fn is_up(&self) -> bool {
        self.up.load(Ordering::Relaxed)
    }

    /// Sends a message, if it is connected and the queue is not full: what is sent later would be old.
    pub fn publish(&self, message: Publish) -> bool {
        let Publish { topic, payload, assured, retain } = message;
        self.is_up() && self.client.try_publish(topic, qos(assured), retain, payload).is_ok()
    }

    /// Ends it in order: its last will is not done.
    pub fn close(mut self) {
        let _ = self.client.try_disconnect();
        // The thread sends it, and ends as the broker closes; not longer than that should take.
        for _ in 0..20 {
            std::thread::sleep(Duration::from_millis(10));
            if !self.is_up() {
                break;
            }
        }
        self.end();
    }

    fn end(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.end();
    }
}

fn qos(assured: bool) -> QoS {
    if assured { QoS::AtLeastOnce } else { QoS::AtMostOnce }
}

#[cfg(feature = "tls")]
fn secure(options: &mut MqttOptions, broker: &Broker) -> Result<(), String> {
    if let Some(file) = &broker.authority {
        let ca = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
        let tls = rumqttc::TlsConfiguration::Simple { ca, alpn: None, client_auth: None };
        options.set_transport(rumqttc::Transport::Tls(tls));
    }
    Ok(())
}

#[cfg(not(feature = "tls"))]
fn secure(_options: &mut MqttOptions, broker: &Broker) -> Result<(), String> {
    match broker.authority {
        Some(_) => Err("this build has no TLS: build it with the feature `tls`".into()),
        None => Ok(()),
    }
}
