//! A connection to a broker that reconnects by itself.

use super::bridge::MqttMessage;
use crate::setup_error::SetupError;
use rumqttc::{
    AsyncClient, ConnectionError, Event, EventLoop, LastWill, MqttOptions, NetworkOptions, Packet, QoS,
    SubscribeFilter, SubscribeReasonCode,
};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::sync::Notify;

/// Address and login of a broker.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokerAddress {
    /// Host name or address.
    pub host: String,
    /// Port: usually 1883, with TLS 8883.
    pub port: u16,
    /// User and password.
    pub login: Option<(String, String)>,
    /// For TLS: a file with the certificate of the authority that signed the broker's certificate (PEM).
    pub authority: Option<PathBuf>,
}

impl BrokerAddress {
    /// A broker without TLS and login.
    pub fn new(host: &str, port: u16) -> Self {
        Self { host: host.into(), port, login: None, authority: None }
    }
}

/// News from a connection.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkEvent {
    /// It is connected and subscribed.
    Up,
    /// It is not connected, for this reason.
    Down(String),
    /// A message has come.
    Message {
        /// Topic.
        topic: String,
        /// Content.
        payload: Vec<u8>,
        /// Whether it is a retained message, which may be old.
        kept: bool,
        /// When it came.
        came: Instant,
    },
}

/// Largest packet \[bytes\]: what MQTT allows. A smaller limit ends the connection at a larger packet; if the broker has retained that
/// packet, it comes again after each attempt. What is too large is refused by its reader instead.
const LARGEST: usize = 268_435_455 + 5;

/// Largest number of messages that wait to be sent.
const QUEUE: usize = 4_096;

/// If nothing was sent for this long, the connection is tested.
const KEEP_ALIVE: Duration = Duration::from_secs(5);

/// Time between two attempts to connect.
const AGAIN: Duration = Duration::from_millis(200);

/// A connection. If it is dropped, it breaks as if power was lost: the broker sends the last will.
pub struct MqttLink {
    client: AsyncClient,
    stop: Arc<Notify>,
    up: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl std::fmt::Debug for MqttLink {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Link").field("up", &self.is_up()).finish_non_exhaustive()
    }
}

impl MqttLink {
    /// Connects, again after every failure, and subscribes to these topics each time. A thread calls `sink` with the news.
    ///
    /// # Errors
    /// An invalid setting, or a thread that cannot be started.
    pub fn open(
        broker: &BrokerAddress,
        id: &str,
        will: Option<MqttMessage>,
        filters: Vec<String>,
        sink: impl Fn(LinkEvent) + Send + 'static,
    ) -> Result<Self, SetupError> {
        let mut options = MqttOptions::new(id, &broker.host, broker.port);
        options.set_keep_alive(KEEP_ALIVE).set_max_packet_size(LARGEST, LARGEST).set_clean_session(true);
        if let Some((user, password)) = &broker.login {
            options.set_credentials(user, password);
        }
        if let Some(will) = will {
            options.set_last_will(LastWill::new(&will.topic, will.payload, qos(will.at_least_once), will.retain));
        }
        secure(&mut options, broker)?;
        let (client, mut events) = AsyncClient::new(options, QUEUE);
        // Without this, a message waits for the acknowledgement of the one before it, 40 ms and more.
        let mut network = NetworkOptions::new();
        network.set_tcp_nodelay(true);
        events.set_network_options(network);
        let (stop, up) = (Arc::new(Notify::new()), Arc::new(AtomicBool::new(false)));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(SetupError::Thread)?;
        let work =
            LinkWorker { client: client.clone(), filters, sink, up: up.clone(), asks: false, why: String::new() };
        let stopped = stop.clone();
        let thread = std::thread::Builder::new().name(id.into());
        let thread = thread.spawn(move || runtime.block_on(work.go_on(events, &stopped)));
        Ok(Self { client, stop, up, thread: Some(thread.map_err(SetupError::Thread)?) })
    }

    /// Whether it is connected, as far as is known.
    pub fn is_up(&self) -> bool {
        self.up.load(Ordering::Relaxed)
    }

    /// Sends a message, if it is connected and the queue is not full. Otherwise the message is dropped, because it would be old
    /// later.
    pub fn publish(&self, message: MqttMessage) -> bool {
        self.mouth().publish(message)
    }

    /// A sender for other threads.
    pub(crate) fn mouth(&self) -> Publisher {
        Publisher { client: self.client.clone(), up: self.up.clone() }
    }

    /// Ends properly: the broker does not send the last will.
    pub fn close(mut self) {
        let _ = self.client.try_disconnect();
        // The thread ends when the broker closes; this waits no longer than that should take.
        for _ in 0..20 {
            std::thread::sleep(Duration::from_millis(10));
            if !self.is_up() {
                break;
            }
        }
        self.end();
    }

    fn end(&mut self) {
        self.stop.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Sends messages over a link.
#[derive(Clone, Debug)]
pub(crate) struct Publisher {
    client: AsyncClient,
    up: Arc<AtomicBool>,
}

impl Publisher {
    /// As [`MqttLink::publish`].
    pub(crate) fn publish(&self, message: MqttMessage) -> bool {
        let MqttMessage { topic, payload, at_least_once: assured, retain } = message;
        self.up.load(Ordering::Relaxed) && self.client.try_publish(topic, qos(assured), retain, payload).is_ok()
    }
}

impl Drop for MqttLink {
    fn drop(&mut self) {
        self.end();
    }
}

/// The state of the thread of a link.
struct LinkWorker<F> {
    client: AsyncClient,
    filters: Vec<String>,
    sink: F,
    up: Arc<AtomicBool>,
    /// Whether it is connected, but not subscribed yet.
    asks: bool,
    /// The last reported reason why it is not connected.
    why: String,
}

impl<F: Fn(LinkEvent)> LinkWorker<F> {
    /// Runs until it is stopped. An attempt to connect is never given up after a time: a broker that takes longer than that
    /// would never be reached.
    async fn go_on(mut self, mut events: EventLoop, stop: &Notify) {
        loop {
            let event = tokio::select! {
                biased;
                () = stop.notified() => return,
                event = events.poll() => event,
            };
            match event {
                Ok(event) => self.take(event),
                Err(ConnectionError::RequestsDone) => return,
                Err(error) => {
                    self.asks = false;
                    self.is_down(error.to_string());
                    // Unsent messages would be old when they can be sent, and another supervisor may be active by then.
                    events.clean();
                    events.pending.clear();
                    tokio::select! {
                        biased;
                        () = stop.notified() => return,
                        () = tokio::time::sleep(AGAIN) => {}
                    }
                }
            }
            // Retried with each event as long as the queue is full.
            let wanted = || self.filters.iter().map(|filter| SubscribeFilter::new(filter.clone(), QoS::AtLeastOnce));
            if self.asks && self.client.try_subscribe_many(wanted()).is_ok() {
                self.asks = false;
            }
        }
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::Incoming(Packet::ConnAck(_)) if self.filters.is_empty() => self.is_up(),
            Event::Incoming(Packet::ConnAck(_)) => self.asks = true,
            Event::Incoming(Packet::SubAck(answer)) if !self.up.load(Ordering::Relaxed) => {
                let refused = |(code, _): &(&SubscribeReasonCode, _)| **code == SubscribeReasonCode::Failure;
                match answer.return_codes.iter().zip(&self.filters).find(refused) {
                    None => self.is_up(),
                    Some((_, filter)) => self.is_down(format!("the broker does not let us read {filter}")),
                }
            }
            Event::Incoming(Packet::Publish(message)) => {
                let (payload, kept) = (message.payload.to_vec(), message.retain);
                (self.sink)(LinkEvent::Message { topic: message.topic, payload, kept, came: Instant::now() });
            }
            _ => {}
        }
    }

    fn is_up(&mut self) {
        self.why.clear();
        self.up.store(true, Ordering::Relaxed);
        (self.sink)(LinkEvent::Up);
    }

    /// Reports a reason if it is new, because attempts are repeated.
    fn is_down(&mut self, why: String) {
        if self.up.swap(false, Ordering::Relaxed) || why != self.why {
            self.why.clone_from(&why);
            (self.sink)(LinkEvent::Down(why));
        }
    }
}

fn qos(assured: bool) -> QoS {
    if assured { QoS::AtLeastOnce } else { QoS::AtMostOnce }
}

#[cfg(feature = "tls")]
fn secure(options: &mut MqttOptions, broker: &BrokerAddress) -> Result<(), SetupError> {
    if let Some(file) = &broker.authority {
        options.set_transport(super::tls::transport(file)?);
    }
    Ok(())
}

#[cfg(not(feature = "tls"))]
fn secure(_options: &mut MqttOptions, broker: &BrokerAddress) -> Result<(), SetupError> {
    match broker.authority {
        Some(_) => Err(SetupError::NoTls),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::net::{TcpListener, TcpStream};
    use std::sync::mpsc::{Receiver, channel};

    /// Reads one packet of less than 128 bytes: its kind.
    fn packet(stream: &mut TcpStream) -> std::io::Result<u8> {
        let mut head = [0; 2];
        stream.read_exact(&mut head)?;
        stream.read_exact(&mut vec![0; head[1].into()])?;
        Ok(head[0])
    }

    /// Reads a packet of any length: its kind, and what follows its length.
    fn long_packet(stream: &mut TcpStream) -> (u8, Vec<u8>) {
        let (mut byte, mut length, mut shift) = ([0], 0, 0);
        stream.read_exact(&mut byte).unwrap();
        let kind = byte[0];
        loop {
            stream.read_exact(&mut byte).unwrap();
            length |= usize::from(byte[0] & 0x7f) << shift;
            shift += 7;
            if byte[0] & 0x80 == 0 {
                break;
            }
        }
        let mut rest = vec![0; length];
        stream.read_exact(&mut rest).unwrap();
        (kind, rest)
    }

    /// A link with two topics, and a broker that says this; its first connection is the one that it keeps.
    fn linked(says: fn(&mut TcpStream)) -> (MqttLink, JoinHandle<TcpStream>, Receiver<LinkEvent>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let broker = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            says(&mut stream);
            stream
        });
        let (sender, news) = channel();
        let filters = ["a/b", "c/d"].map(String::from).to_vec();
        let link = MqttLink::open(&BrokerAddress::new("127.0.0.1", port), "id", None, filters, move |it| {
            drop(sender.send(it))
        });
        (link.unwrap(), broker, news)
    }

    /// Connections were given up after 50 ms and begun anew: behind a slow line, or on a busy machine, for ever.
    #[test]
    fn a_broker_that_takes_its_time_is_waited_for() {
        let (link, broker, news) = linked(|stream| {
            assert_eq!(packet(stream).unwrap(), 0x10);
            std::thread::sleep(Duration::from_millis(300));
            stream.write_all(&[0x20, 2, 0, 0]).unwrap();
            assert_eq!(packet(stream).unwrap(), 0x82);
            std::thread::sleep(Duration::from_millis(300));
            stream.write_all(&[0x90, 4, 0, 1, 1, 1]).unwrap();
        });
        let stream = broker.join().unwrap();
        assert_eq!(news.recv().unwrap(), LinkEvent::Up);
        assert!(link.is_up());
        drop((link, stream));
    }

    /// A retained message of more than 1 MiB ended the connection, and came again after each attempt.
    #[test]
    fn large_messages_go_both_ways() {
        const SIZE: usize = 3 << 20;
        let (link, broker, news) = linked(|stream| {
            packet(stream).unwrap();
            stream.write_all(&[0x20, 2, 0, 0]).unwrap();
            packet(stream).unwrap();
            stream.write_all(&[0x90, 4, 0, 1, 1, 1]).unwrap();
            // Retained, for the topic a/b.
            let length = SIZE + 5;
            let digits = [0, 7, 14].map(|shift| (length >> shift & 0x7f) as u8 | 0x80);
            stream.write_all(&[0x31]).unwrap();
            stream.write_all(&[digits[0], digits[1], digits[2], (length >> 21) as u8]).unwrap();
            stream.write_all(&[0, 3, b'a', b'/', b'b']).unwrap();
            stream.write_all(&vec![b' '; SIZE]).unwrap();
            let (kind, rest) = long_packet(stream);
            assert_eq!((kind, rest.len()), (0x30, SIZE + 5));
        });
        assert_eq!(news.recv().unwrap(), LinkEvent::Up);
        let LinkEvent::Message { topic, payload, kept, .. } = news.recv().unwrap() else { panic!("no message") };
        assert_eq!((topic.as_str(), payload.len(), kept), ("a/b", SIZE, true));
        let payload = vec![b' '; SIZE];
        assert!(link.publish(MqttMessage { topic: "a/b".into(), payload, at_least_once: false, retain: false }));
        let stream = broker.join().unwrap();
        drop((link, stream));
    }

    #[test]
    fn what_may_not_be_read_is_said() {
        let (link, broker, news) = linked(|stream| {
            packet(stream).unwrap();
            stream.write_all(&[0x20, 2, 0, 0]).unwrap();
            packet(stream).unwrap();
            stream.write_all(&[0x90, 4, 0, 1, 1, 0x80]).unwrap();
        });
        let stream = broker.join().unwrap();
        assert_eq!(news.recv().unwrap(), LinkEvent::Down("the broker does not let us read c/d".into()));
        assert!(!link.is_up());
        drop((link, stream));
    }
}
