//! The memory map of the QEMU machine that stands for the target, and the linker script of its runtime.

use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(armv6m, armv8m)");
    let target = env::var("TARGET")?;
    // Origin of flash and of RAM, and their sizes in KiB.
    let memory = match target.as_str() {
        "thumbv6m-none-eabi" => {
            println!("cargo:rustc-cfg=armv6m");
            regions(0x0000_0000, 256, 0x2000_0000, 16) // microbit
        }
        "thumbv7em-none-eabihf" if env::var_os("CARGO_FEATURE_STM32F405").is_some() => {
            regions(0x0800_0000, 1024, 0x2000_0000, 128) // netduinoplus2
        }
        "thumbv8m.main-none-eabihf" => {
            println!("cargo:rustc-cfg=armv8m");
            regions(0x1000_0000, 4096, 0x3800_0000, 2048) // mps2-an505
        }
        "thumbv7m-none-eabi" | "thumbv7em-none-eabihf" => regions(0x0000_0000, 4096, 0x2000_0000, 4096), // mps2
        "riscv32imc-unknown-none-elf" => {
            // virt has RAM only; the program is told flash from RAM all the same.
            let aliases = [("TEXT", "FLASH"), ("RODATA", "FLASH"), ("DATA", "RAM"), ("BSS", "RAM"), ("HEAP", "RAM")];
            let aliases = aliases.into_iter().chain([("STACK", "RAM")]);
            let aliases = aliases.map(|(name, region)| format!("REGION_ALIAS(\"REGION_{name}\", {region});\n"));
            regions(0x8000_0000, 4096, 0x8040_0000, 4096) + &aliases.collect::<String>()
        }
        _ => return Err(format!("no machine for {target}: docs/maintain/firmware.md lists the targets").into()),
    };
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("memory.x"), memory)?;
    println!("cargo:rustc-link-search={}", out.display());
    if target.starts_with("riscv") {
        println!("cargo:rustc-link-arg-bins=-Tmemory.x");
    }
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    Ok(())
}

fn regions(flash: u32, flash_kib: u32, ram: u32, ram_kib: u32) -> String {
    format!(
        "MEMORY {{\n  FLASH : ORIGIN = {flash:#x}, LENGTH = {flash_kib}K\n  RAM : ORIGIN = {ram:#x}, LENGTH = {ram_kib}K\n}}\n"
    )
}
