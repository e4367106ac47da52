//! Messages as lines: read with a limit, written one after the other.

use std::io::{self, BufRead, Write};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// A line without its end.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Line {
    /// Its bytes.
    Whole(Vec<u8>),
    /// It was longer than the limit and is gone.
    TooLong,
}

/// The next line that is not blank; none at the end of input. A line beyond `limit` bytes is read past, not kept.
pub(super) fn next_line(reader: &mut impl BufRead, limit: usize) -> io::Result<Option<Line>> {
    let (mut line, mut too_long, mut any) = (Vec::new(), false, false);
    loop {
        let buffer = match reader.fill_buf() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            other => other?,
        };
        if buffer.is_empty() && !any {
            return Ok(None);
        }
        let end = buffer.iter().position(|&b| b == b'\n');
        let part = &buffer[..end.unwrap_or(buffer.len())];
        any = true;
        too_long |= line.len() + part.len() > limit;
        if too_long {
            line = Vec::new();
        } else {
            line.extend_from_slice(part);
        }
        let (read, ended) = (part.len() + usize::from(end.is_some()), end.is_some() || buffer.is_empty());
        reader.consume(read);
        if ended {
            if too_long {
                return Ok(Some(Line::TooLong));
            }
            if !line.trim_ascii().is_empty() {
                return Ok(Some(Line::Whole(line)));
            }
            (line, any) = (Vec::new(), false);
        }
    }
}

/// Where replies and notifications go: a queue that a thread of its own writes, so that nobody waits for a slow client.
#[derive(Clone)]
pub(super) struct Outbox(Sender<String>);

impl Outbox {
    /// Sends a message. Where the client has gone there is nobody to tell.
    pub(super) fn send(&self, message: &serde_json::Value) {
        let mut line = message.to_string();
        line.push('\n');
        let _ = self.0.send(line);
    }
}

/// Starts the thread that writes to `out`; it ends when all outboxes are gone, or the client is.
pub(super) fn outbox(mut out: impl Write + Send + 'static) -> (Outbox, JoinHandle<()>) {
    let (sender, receiver): (_, Receiver<String>) = channel();
    let writer = thread::spawn(move || {
        for line in receiver {
            if out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_err() {
                break;
            }
        }
    });
    (Outbox(sender), writer)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &[u8], limit: usize) -> Vec<Line> {
        // A small buffer, so that lines come in pieces.
        let mut reader = io::BufReader::with_capacity(3, text);
        std::iter::from_fn(|| next_line(&mut reader, limit).unwrap()).collect()
    }

    #[test]
    fn lines_come_whole_blank_ones_not_and_long_ones_are_told() {
        let whole = |text: &str| Line::Whole(text.as_bytes().to_vec());
        assert_eq!(lines(b"one\n\n \r\ntwo\nhalf", 100), [whole("one"), whole("two"), whole("half")]);
        assert_eq!(lines(b"12345\n123456\n12", 5), [whole("12345"), Line::TooLong, whole("12")]);
        assert_eq!(lines(b"", 5), []);
        assert_eq!(lines(b"\n\n", 5), []);
    }
}
