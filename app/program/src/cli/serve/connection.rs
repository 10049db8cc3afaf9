//! A connection with a browser, encrypted or not, on which no call waits forever.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rustls::{ServerConfig, ServerConnection};

/// A connection with a browser. Clones share the connection, so that one can read while another one writes.
#[derive(Clone)]
pub struct Connection(Arc<Inner>);

struct Inner {
    socket: TcpStream,
    /// Locked while bytes are sent, so that the output of two clones does not mix.
    sending: Mutex<()>,
    tls: Option<Tls>,
    timeout: Mutex<Timeout>,
}

/// The time limit of reading and writing.
#[derive(Clone, Copy)]
enum Timeout {
    /// For all calls together.
    Until(Instant),
    /// For each call.
    Each(Duration),
}

struct Tls {
    state: Mutex<ServerConnection>,
}

impl Connection {
    /// Takes over a connection, encrypted if `tls` is given. The timeout applies to all reading and writing together.
    ///
    /// # Errors
    /// If the connection is lost.
    pub fn new(
        socket: TcpStream,
        tls: Option<&Arc<ServerConfig>>,
        timeout: Duration,
    ) -> io::Result<Connection> {
        socket.set_nodelay(true)?;
        let tls = tls.map(|config| ServerConnection::new(config.clone())).transpose();
        let tls = tls.map_err(io::Error::other)?;
        let tls = tls.map(|mut state| {
            // Without a limit a message is always buffered as a whole, so that another writer's cannot get into it.
            state.set_buffer_limit(None);
            Tls { state: Mutex::new(state) }
        });
        let timeout = Mutex::new(Timeout::Until(Instant::now() + timeout));
        Ok(Connection(Arc::new(Inner { socket, sending: Mutex::new(()), tls, timeout })))
    }

    /// Limits the total time of all reading and writing from now on.
    pub fn set_deadline(&self, time: Duration) {
        *lock(&self.0.timeout) = Timeout::Until(Instant::now() + time);
    }

    /// Limits the time of each call that reads or writes.
    pub fn set_timeout(&self, time: Duration) {
        *lock(&self.0.timeout) = Timeout::Each(time);
    }

    /// Closes the connection, which wakes up all waiting calls.
    pub fn close(&self) {
        if let Some(tls) = &self.0.tls {
            lock(&tls.state).send_close_notify();
            // A lost connection needs no notification.
            let _ = self.flush_tls(tls);
        }
        let _ = self.0.socket.shutdown(Shutdown::Both);
    }

    /// Returns how long the next call may wait, never zero.
    ///
    /// # Errors
    /// `TimedOut` after the deadline.
    fn timeout(&self) -> io::Result<Duration> {
        match *lock(&self.0.timeout) {
            Timeout::Each(time) => Ok(time),
            Timeout::Until(end) => {
                let left = end.saturating_duration_since(Instant::now());
                if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(left) }
            }
        }
    }

    fn receive(&self, to: &mut [u8]) -> io::Result<usize> {
        self.0.socket.set_read_timeout(Some(self.timeout()?))?;
        (&self.0.socket).read(to)
    }

    fn transmit(&self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            self.0.socket.set_write_timeout(Some(self.timeout()?))?;
            match (&self.0.socket).write(bytes)? {
                0 => return Err(io::ErrorKind::WriteZero.into()),
                written => bytes = &bytes[written..],
            }
        }
        Ok(())
    }

    /// Sends all pending records in order.
    fn flush_tls(&self, tls: &Tls) -> io::Result<()> {
        let _sending = lock(&self.0.sending);
        let mut records = Vec::new();
        let mut state = lock(&tls.state);
        while state.wants_write() {
            state.write_tls(&mut records)?;
        }
        drop(state);
        self.transmit(&records)
    }

    /// Processes received records, including those of the handshake, and sends TLS's own replies.
    fn process_tls(&self, tls: &Tls, mut records: &[u8]) -> io::Result<()> {
        let mut state = lock(&tls.state);
        let mut processed = Ok(());
        while !records.is_empty() && processed.is_ok() {
            state.read_tls(&mut records)?;
            processed = state.process_new_packets().map(drop);
        }
        let has_reply = state.wants_write();
        drop(state);
        if has_reply {
            self.flush_tls(tls)?;
        }
        processed.map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    }
}

impl Read for Connection {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let Some(tls) = &self.0.tls else { return self.receive(to) };
        let mut records = [0; 4096];
        loop {
            match lock(&tls.state).reader().read(to) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                done => return done,
            }
            match self.receive(&mut records)? {
                0 => return Ok(0),
                length => self.process_tls(tls, &records[..length])?,
            }
        }
    }
}

impl Write for Connection {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(tls) = &self.0.tls else {
            let _sending = lock(&self.0.sending);
            self.transmit(bytes)?;
            return Ok(bytes.len());
        };
        let taken = lock(&tls.state).writer().write(bytes)?;
        self.flush_tls(tls)?;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
