//! Traps: small functions made at run time, one per name, so that a call of an undefined function reports its name.

use std::sync::Mutex;

use anyhow::{Result, ensure};

use crate::host::{fatal, lock};

static NAMES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Size of a trap in bytes.
const SIZE: usize = 32;

/// Makes a trap for each name, and returns their addresses. Traps are never freed.
///
/// # Errors
/// Fails if there is no memory.
pub fn traps(names: &[String]) -> Result<Vec<usize>> {
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let mut all = lock(&NAMES);
    let first = all.len();
    all.extend_from_slice(names);
    let length = names.len() * SIZE;
    // SAFETY: creates a new anonymous mapping at an address chosen by the kernel.
    let memory = unsafe {
        libc::mmap(
            std::ptr::null_mut(),
            length,
            libc::PROT_READ | libc::PROT_WRITE,
            libc::MAP_PRIVATE | libc::MAP_ANONYMOUS,
            -1,
            0,
        )
    };
    ensure!(memory != libc::MAP_FAILED, "no memory for traps: {}", std::io::Error::last_os_error());
    let mut code = Vec::with_capacity(length);
    for index in first..first + names.len() {
        code.extend_from_slice(&trap(index as u32, sprung as *const () as u64));
    }
    // SAFETY: the mapping has `length` bytes and is writable, and nobody else knows it.
    unsafe { std::ptr::copy_nonoverlapping(code.as_ptr(), memory.cast(), length) };
    // SAFETY: protects the whole mapping made above. The code is never written again.
    let protected = unsafe { libc::mprotect(memory, length, libc::PROT_READ | libc::PROT_EXEC) };
    ensure!(protected == 0, "no executable memory for traps: {}", std::io::Error::last_os_error());
    Ok((0..names.len()).map(|index| memory as usize + index * SIZE).collect())
}

/// Returns the machine code of `sprung(index)`: `mov edi, index; movabs rax, target; jmp rax`.
#[cfg(target_arch = "x86_64")]
fn trap(index: u32, target: u64) -> [u8; SIZE] {
    let mut code = [0xcc; SIZE];
    code[0] = 0xbf;
    code[1..5].copy_from_slice(&index.to_le_bytes());
    code[5..7].copy_from_slice(&[0x48, 0xb8]);
    code[7..15].copy_from_slice(&target.to_le_bytes());
    code[15..17].copy_from_slice(&[0xff, 0xe0]);
    code
}

/// Returns the machine code of `sprung(index)`: `ldr w0, 16; ldr x16, 24; br x16`.
#[cfg(target_arch = "aarch64")]
fn trap(index: u32, target: u64) -> [u8; SIZE] {
    let mut code = [0; SIZE];
    code[0..4].copy_from_slice(&0x1800_0080_u32.to_le_bytes());
    code[4..8].copy_from_slice(&0x5800_00b0_u32.to_le_bytes());
    code[8..12].copy_from_slice(&0xd61f_0200_u32.to_le_bytes());
    code[16..20].copy_from_slice(&index.to_le_bytes());
    code[24..32].copy_from_slice(&target.to_le_bytes());
    code
}

extern "C" fn sprung(index: u32) -> ! {
    let name = lock(&NAMES).get(index as usize).cloned().unwrap_or_default();
    fatal(format!("the application called {name}, which the host does not answer: add it to the host"))
}
