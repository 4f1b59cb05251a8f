//! The bytes of all messages, as `firmware/README.md` lists them for clients in other languages, are those of the code. `UPDATE=1` writes the list.

use pcr_core::{Curve, PassingState, TurnSide};
use pcr_supervisor::frame::Damage;
use pcr_supervisor::message::{Answer, Reason, Refusal, Request, Room};
use serde_reflection::{ContainerFormat, Format, Named, Registry, Tracer, TracerConfig, VariantFormat};
use std::fmt::Write;
use std::path::Path;

/// All types that messages consist of.
fn registry() -> Registry {
    let mut tracer = Tracer::new(TracerConfig::default());
    tracer.trace_simple_type::<Request<f32>>().expect("requests");
    tracer.trace_simple_type::<Answer<f32>>().expect("answers");
    tracer.trace_simple_type::<Refusal>().expect("refusals");
    tracer.trace_simple_type::<Damage>().expect("damages");
    tracer.trace_simple_type::<Reason>().expect("reasons");
    tracer.trace_simple_type::<Room>().expect("rooms");
    tracer.trace_simple_type::<Curve<f32>>().expect("curves");
    tracer.trace_simple_type::<TurnSide>().expect("sides");
    tracer.trace_simple_type::<PassingState>().expect("orders");
    tracer.registry().expect("all variants")
}

fn format(format: &Format) -> String {
    match format {
        // In the number format of the build.
        Format::F32 => "number".into(),
        Format::TypeName(name) => name.clone(),
        Format::Seq(each) => format!("list of {}", self::format(each)),
        Format::TupleArray { content, size } => vec![self::format(content); *size].join(" "),
        Format::Tuple(parts) => parts.iter().map(self::format).collect::<Vec<_>>().join(" "),
        other => format!("{other:?}").to_lowercase(),
    }
}

fn fields(all: &[Named<Format>]) -> String {
    all.iter().map(|field| format!("{}: {}", field.name, format(&field.value))).collect::<Vec<_>>().join(", ")
}

fn variant(content: &VariantFormat) -> String {
    match content {
        VariantFormat::Unit => String::new(),
        VariantFormat::NewType(of) => format(of),
        VariantFormat::Tuple(parts) => parts.iter().map(format).collect::<Vec<_>>().join(" "),
        VariantFormat::Struct(all) => fields(all),
        VariantFormat::Variable(_) => unreachable!("all are known"),
    }
}

/// A line for each type, and below those that are one of several kinds a line for each kind, with its number.
fn list() -> String {
    let mut text = String::new();
    for (name, container) in registry() {
        match container {
            ContainerFormat::Enum(kinds) => {
                writeln!(text, "{name}").expect("a text");
                for (number, kind) in kinds {
                    writeln!(text, "{}", format!("  {number:2} {} {}", kind.name, variant(&kind.value)).trim_end())
                        .expect("a text");
                }
            }
            ContainerFormat::Struct(all) => writeln!(text, "{name} = {}", fields(&all)).expect("a text"),
            ContainerFormat::NewTypeStruct(of) => writeln!(text, "{name} = {}", format(&of)).expect("a text"),
            other => panic!("{name}: {other:?}"),
        }
    }
    text
}

#[test]
fn the_readme_lists_the_bytes_of_all_messages() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let text = std::fs::read_to_string(&path).expect("the README");
    let (before, rest) = text.split_once("```text\n").expect("a list in the README");
    let (listed, after) = rest.split_once("```").expect("its end");
    let made = list();
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, format!("{before}```text\n{made}```{after}")).expect("the README can be written");
    } else {
        assert!(
            listed == made,
            "firmware/README.md lists other bytes: UPDATE=1 cargo test -p pcr-supervisor wire_format\n{made}"
        );
    }
}
