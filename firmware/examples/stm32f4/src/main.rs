//! The supervisor of a fleet on an STM32F405, with RTIC: USART 2 at 115200 baud on PA2 and PA3, an 8 MHz crystal.
//!
//! Bytes come in by interrupt, whatever is computed meanwhile, so that none is lost; requests are done in `idle`, which every task may
//! interrupt: the table belongs to it alone. A controller of motors would be a task of a higher priority.
#![no_std]
#![no_main]

#[rtic::app(device = stm32f4xx_hal::pac, peripherals = true)]
mod app {
    use example_fleet::{Line, Supervisor, WATCHDOG_MS, supervisor};
    use heapless::spsc::{Consumer, Producer, Queue};
    use stm32f4xx_hal::pac::USART2;
    use stm32f4xx_hal::prelude::*;
    use stm32f4xx_hal::rcc;
    use stm32f4xx_hal::serial::{Config, Rx, Tx};
    use stm32f4xx_hal::watchdog::IndependentWatchdog;

    /// The way out.
    pub struct Port {
        tx: Tx<USART2>,
        watchdog: IndependentWatchdog,
    }

    impl Line for Port {
        fn send(&mut self, frame: &[u8]) {
            if self.tx.bwrite_all(frame).is_err() {
                defmt::warn!("a frame was not sent; it is asked for again");
            }
            self.watchdog.feed();
        }

        fn pause(&mut self) {
            self.watchdog.feed();
        }
    }

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        rx: Rx<USART2>,
        received: Producer<'static, u8>,
        bytes: Consumer<'static, u8>,
        port: Port,
        supervisor: &'static mut Supervisor,
    }

    #[init(local = [queue: Queue<u8, 512> = Queue::new()])]
    fn init(context: init::Context) -> (Shared, Local) {
        let device = context.device;
        let mut rcc = device.RCC.freeze(rcc::Config::hse(8.MHz()).sysclk(168.MHz()));
        let pins = device.GPIOA.split(&mut rcc);
        let config = Config::default().baudrate(115_200.bps());
        let serial = device.USART2.serial((pins.pa2, pins.pa3), config, &mut rcc);
        let (tx, mut rx) = defmt::unwrap!(serial.map_err(drop).ok()).split();
        rx.listen();
        let mut watchdog = IndependentWatchdog::new(device.IWDG);
        watchdog.start(WATCHDOG_MS.millis());
        let (received, bytes) = context.local.queue.split();
        (Shared {}, Local { rx, received, bytes, port: Port { tx, watchdog }, supervisor: supervisor() })
    }

    #[idle(local = [bytes, port, supervisor])]
    fn idle(context: idle::Context) -> ! {
        let idle::LocalResources { bytes, port, supervisor, .. } = context.local;
        loop {
            port.pause();
            if let Some(byte) = bytes.dequeue() {
                supervisor.take(byte, port);
            }
        }
    }

    #[task(binds = USART2, priority = 2, local = [rx, received])]
    fn receive(context: receive::Context) {
        // A byte that was damaged or has no room is missing in its frame, which is then asked for again.
        if let Ok(byte) = context.local.rx.read() {
            let _ = context.local.received.enqueue(byte);
        }
    }
}
