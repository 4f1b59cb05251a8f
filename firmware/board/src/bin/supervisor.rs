//! The supervisor on a serial line: agents come in as frames, regions go out. `pcr-link serial` is the other end.
#![no_std]
#![no_main]

use pcr_board::uart::Uart;
use pcr_board::{AGENTS, Number, entry};
use pcr_supervisor::frame::{self, Receiver};
use pcr_supervisor::message::Refusal;
use pcr_supervisor::{Answer, Service};
use static_cell::ConstStaticCell;

static SERVICE: ConstStaticCell<Service<Number>> = ConstStaticCell::new(Service::new(&AGENTS));
static RECEIVER: ConstStaticCell<Receiver> = ConstStaticCell::new(Receiver::new());

#[entry]
fn main() -> ! {
    let mut uart = Uart::start();
    if let (Some(service), Some(receiver)) = (SERVICE.try_take(), RECEIVER.try_take()) {
        loop {
            if let Some((sequence, message)) = receiver.take(uart.read()) {
                let mut send = |answer: Answer<Number>| {
                    // Every answer is shorter than a frame may be.
                    if let Some(bytes) = frame::encode(sequence, &answer) {
                        uart.write(&bytes);
                    }
                };
                match message {
                    Ok(request) => service.answer(request, send),
                    Err(damage) => send(Answer::Refused(Refusal::Frame(damage))),
                }
            }
        }
    }
    // The cells are taken once, above.
    loop {}
}
