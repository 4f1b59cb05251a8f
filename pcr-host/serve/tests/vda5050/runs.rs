//! Fleets at work.

use crate::broker::Mosquitto;
use crate::schemas;
use crate::site::{Desk, Scene, Site, interfaces};
use crate::yard::MIXED;
use pcr_formats::vda5050::version::Version;
use pcr_serve::entry::Nowhere;
use pcr_serve::vda5050::mqtt::{Broker, Link, News};
use pcr_serve::vehicles::drive::Abilities;
use pcr_serve::vehicles::weather::Climate;
use std::sync::mpsc::channel;

pub(crate) const FAIR: Scene<'_> = Scene {
    count: 2,
    versions: &[Version::V2_1],
    abilities: &[Abilities {
        radius: 0.4,
        speed: 1.0,
        acceleration: 0.5,
        rotation: 1.0,
        slip: 0.05,
        drift: 0.02,
        noise: 0.02,
        delay: 0.0,
    }],
    climate: Climate { lost: 0.0, twice: 0.0, late: 0.0, delay: 0.0 },
    drops: 0.0,
    pace: 10.0,
};

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn two_vehicles_do_their_missions() {
    let broker = Mosquitto::start("two");
    let (mut site, profiles) = Site::open(&broker, FAIR);
    let desk = Desk::open(&broker, profiles, "two", Box::new(Nowhere));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(1)));
    assert!(told.is_ok(), "{}", desk.tell());
    let found = site.close();
    assert!(found.travelled > 5.0, "{found:?}");
    desk.close().unwrap();
}

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn a_fleet_of_all_editions_keeps_apart() {
    let broker = Mosquitto::start("fleet");
    // By seconds of ours: ten of the vehicles go by in one..
    let scene = Scene { climate: Climate { delay: 1.0, ..MIXED.climate }, drops: 0.02, ..MIXED };
    // Who listens to everything that is said.
    let (sender, said) = channel();
    let everything = ["uagv/#".to_owned(), "fleet/#".to_owned()].to_vec();
    let ear = Link::open(&broker.address(), "ear", None, everything, move |news| drop(sender.send(news))).unwrap();
    let (mut site, profiles) = Site::open(&broker, scene);
    let desk = Desk::open(&broker, profiles, "fleet", Box::new(Nowhere));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(10)));
    assert!(told.is_ok(), "{}", desk.tell());
    let found = site.close();
    assert!(found.travelled > 100.0, "{found:?}");
    desk.close().unwrap();
    ear.close();
    let messages = said.try_iter().filter_map(|news| match news {
        News::Message { topic, payload, .. } => Some((topic, payload)),
        _ => None,
    });
    let seen = schemas::check(&messages.collect::<Vec<_>>(), &interfaces());
    // Every kind of every edition was said.
    for version in Version::ALL {
        for kind in ["order", "state", "visualization", "connection", "factsheet", "instantActions"] {
            assert!(seen.contains_key(&format!("{version} {kind}")), "{seen:?}");
        }
    }
}

/// What a broker says first to who comes.
pub(crate) fn first(broker: &Broker) -> News {
    let (sender, news) = channel();
    let link = Link::open(broker, "who", None, vec!["a/b".into()], move |it| drop(sender.send(it))).unwrap();
    let first = news.recv().unwrap();
    link.close();
    first
}

/// Whoever had no right to the broker tried again for ever, and said nothing.
#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn a_broker_with_passwords_lets_in_who_has_one() {
    let mosquitto = Mosquitto::guarded("guarded", "pcr", "secret");
    let broker = mosquitto.address();
    let with = |password: &str| Broker { login: Some(("pcr".into(), password.into())), ..broker.clone() };
    for refused in [first(&Broker { login: None, ..broker.clone() }), first(&with("guess"))] {
        assert!(matches!(&refused, News::Down(why) if why.contains("NotAuthorized")), "{refused:?}");
    }
    assert_eq!(first(&with("secret")), News::Up);
}
