//! What was made, kept by everything it was made from: for models that are built again with a little changed.

use crate::geometry::{EdgeCurve, SurfaceGeometry};
use crate::model::Coedge;
use coolinggen_nurbs::{Curve, Homogeneous, Knots, Surface, VectorSpace};
use glam::{DVec2, DVec3};
use std::cell::OnceCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};

/// Everything that something was made from, bit by bit: what has an equal key is equal.
#[derive(Clone, Debug, Default)]
pub struct Key {
    words: Vec<u64>,
    /// Of the words, once it has been asked for: keys are long, and tables that grow ask again.
    hash: OnceCell<u64>,
}

/// What a [`Key`] can hold.
pub trait Content {
    /// Adds it to the key.
    fn write(&self, key: &mut Key);
}

impl Key {
    /// The key of one thing, or of a tuple of things.
    pub fn of(content: impl Content) -> Self {
        Self::default().and(content)
    }

    /// This key and more.
    #[must_use]
    pub fn and(mut self, content: impl Content) -> Self {
        content.write(&mut self);
        self
    }

    fn push(&mut self, word: u64) {
        self.words.push(word);
        self.hash = OnceCell::new();
    }

    /// Mixes the words: nobody makes keys collide on purpose.
    fn mixed(&self) -> u64 {
        const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
        let mix = |hash: u64, word: &u64| (hash.rotate_left(23) ^ word).wrapping_mul(FACTOR);
        let hash = self.words.iter().fold(0, mix);
        hash ^ (hash >> 29)
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.words == other.words
    }
}

impl Eq for Key {}

impl Hash for Key {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(*self.hash.get_or_init(|| self.mixed()));
    }
}

/// Takes the hashes of keys as they are.
#[derive(Clone, Copy, Debug, Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(self.0.rotate_left(8) ^ u64::from(*byte)));
    }

    fn write_u64(&mut self, hash: u64) {
        self.0 = hash;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Results by their keys. Each build is a round; what no round has used for a while is forgotten.
#[derive(Clone, Debug)]
pub struct Memo<T> {
    kept: HashMap<Key, (T, u64), BuildHasherDefault<Mixed>>,
    round: u64,
    /// Entries after the last round that came to an end.
    settled: usize,
    made: u64,
    idle: bool,
}

/// Rounds that a result outlives unused: going back and forth between designs costs nothing.
const ROUNDS: u64 = 3;
/// How much the rounds that were broken off may leave, relative to what one that came to its end left, and at least.
const LEFT_OVER: (usize, usize) = (3, 1000);

impl<T> Default for Memo<T> {
    fn default() -> Self {
        Self { kept: HashMap::default(), round: 0, settled: 0, made: 0, idle: false }
    }
}

impl<T: Clone> Memo<T> {
    /// A memo for what is built once: it keeps nothing.
    pub fn idle() -> Self {
        Self { idle: true, ..Self::default() }
    }

    /// As [`Memo::get`]; where nothing is kept, no key is made either, which may take longer than what it is for.
    ///
    /// # Errors
    /// As [`Memo::get`].
    pub fn get_by<E>(
        &mut self,
        key: impl FnOnce() -> Key,
        make: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        if self.idle {
            self.made += 1;
            return make();
        }
        self.get(key(), make)
    }

    /// Whether it keeps nothing.
    pub fn is_idle(&self) -> bool {
        self.idle
    }

    /// What is kept under the key, or else is made now.
    ///
    /// # Errors
    /// Those of `make`; nothing is kept then.
    pub fn get<E>(&mut self, key: Key, make: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        if let Some(found) = self.find(&key) {
            return Ok(found);
        }
        let value = make()?;
        self.keep(key, value.clone());
        Ok(value)
    }

    /// What is kept under the key.
    pub fn find(&mut self, key: &Key) -> Option<T> {
        let (value, used) = self.kept.get_mut(key)?;
        *used = self.round;
        Some(value.clone())
    }

    /// Keeps what was made.
    pub fn keep(&mut self, key: Key, value: T) {
        self.made += 1;
        if !self.idle {
            self.kept.insert(key, (value, self.round));
        }
    }

    /// Ends a round: one that came to its end, or one that was broken off, whose results serve the next.
    pub fn end_round(&mut self, complete: bool) {
        let most = (LEFT_OVER.0 * self.settled).max(LEFT_OVER.1);
        if !complete {
            if self.kept.len() > most {
                self.kept.clear();
            }
            return;
        }
        self.round += 1;
        let oldest = self.round.saturating_sub(ROUNDS);
        self.kept.retain(|_, (_, used)| *used >= oldest);
        self.settled = self.kept.len();
    }

    /// How many results have been made so far, and not found.
    pub fn made(&self) -> u64 {
        self.made
    }
}

impl Content for u64 {
    fn write(&self, key: &mut Key) {
        key.push(*self);
    }
}

impl Content for usize {
    fn write(&self, key: &mut Key) {
        key.push(*self as u64);
    }
}

impl Content for bool {
    fn write(&self, key: &mut Key) {
        key.push(u64::from(*self));
    }
}

impl Content for f64 {
    fn write(&self, key: &mut Key) {
        key.push(self.to_bits());
    }
}

impl Content for DVec2 {
    fn write(&self, key: &mut Key) {
        self.to_array().map(f64::to_bits).iter().for_each(|bits| key.push(*bits));
    }
}

impl Content for DVec3 {
    fn write(&self, key: &mut Key) {
        self.to_array().map(f64::to_bits).iter().for_each(|bits| key.push(*bits));
    }
}

impl<V: VectorSpace + Content> Content for Homogeneous<V> {
    fn write(&self, key: &mut Key) {
        (self.weighted, self.weight).write(key);
    }
}

impl Content for str {
    fn write(&self, key: &mut Key) {
        self.len().write(key);
        self.bytes().for_each(|byte| key.push(u64::from(byte)));
    }
}

impl<T: Content + ?Sized> Content for &T {
    fn write(&self, key: &mut Key) {
        (**self).write(key);
    }
}

impl<T: Content> Content for [T] {
    fn write(&self, key: &mut Key) {
        self.len().write(key);
        key.words.reserve(size_of_val(self) / size_of::<u64>());
        self.iter().for_each(|entry| entry.write(key));
    }
}

impl<T: Content> Content for Option<T> {
    fn write(&self, key: &mut Key) {
        self.is_some().write(key);
        self.iter().for_each(|entry| entry.write(key));
    }
}

impl<A: Content, B: Content> Content for (A, B) {
    fn write(&self, key: &mut Key) {
        self.0.write(key);
        self.1.write(key);
    }
}

impl<A: Content, B: Content, C: Content> Content for (A, B, C) {
    fn write(&self, key: &mut Key) {
        self.0.write(key);
        self.1.write(key);
        self.2.write(key);
    }
}

impl Content for Knots {
    fn write(&self, key: &mut Key) {
        (self.degree(), self.values()).write(key);
    }
}

impl<V: VectorSpace + Content> Content for Curve<V> {
    fn write(&self, key: &mut Key) {
        (self.knots(), self.points()).write(key);
    }
}

impl<V: VectorSpace + Content> Content for Surface<V> {
    fn write(&self, key: &mut Key) {
        (self.knots_u(), self.knots_v(), self.points()).write(key);
    }
}

/// How an edge runs in a face's parameters; which edge it is does not tell.
impl Content for Coedge {
    fn write(&self, key: &mut Key) {
        (self.forward, &self.pcurve).write(key);
    }
}

impl Content for EdgeCurve {
    fn write(&self, key: &mut Key) {
        match self {
            Self::BSpline(curve) => (0_usize, curve).write(key),
            Self::Rational(curve) => (1_usize, curve.homogeneous()).write(key),
        }
    }
}

impl Content for SurfaceGeometry {
    fn write(&self, key: &mut Key) {
        match self {
            Self::Plane(plane) => (0_usize, plane.origin, (plane.x, plane.y)).write(key),
            Self::Revolution(surface) => (1_usize, surface.meridian()).write(key),
            Self::BSpline(surface) => (2_usize, surface).write(key),
            Self::Rational(surface) => (3_usize, surface.homogeneous()).write(key),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(memo: &mut Memo<u64>, k: u64) -> u64 {
        memo.get(Key::of(k), || Ok::<_, ()>(k * k)).unwrap()
    }

    #[test]
    fn results_are_made_once_and_forgotten_when_long_unused() {
        let mut memo = Memo::default();
        assert_eq!([number(&mut memo, 3), number(&mut memo, 3), number(&mut memo, 4)], [9, 9, 16]);
        assert_eq!(memo.made(), 2);
        for _ in 0..2 * ROUNDS {
            number(&mut memo, 3);
            memo.end_round(true);
        }
        assert_eq!((memo.made(), memo.kept.len()), (2, 1));
        // Rounds that are broken off forget nothing, but do not fill the memory either.
        for k in 0..10_000 {
            number(&mut memo, 5 + k);
            memo.end_round(false);
        }
        assert!(memo.kept.len() <= LEFT_OVER.1 + 1, "{}", memo.kept.len());
        assert_eq!(memo.get(Key::of(7.0), || Err(())), Err(()));
    }

    #[test]
    fn an_idle_memo_keeps_nothing_and_makes_no_keys() {
        let mut memo = Memo::idle();
        for _ in 0..2 {
            assert_eq!(memo.get_by(|| unreachable!("a key"), || Ok::<_, ()>(4)), Ok(4));
        }
        assert_eq!([number(&mut memo, 3), number(&mut memo, 3)], [9, 9]);
        assert_eq!((memo.made(), memo.kept.len()), (4, 0));
    }

    #[test]
    fn keys_tell_apart_what_is_apart() {
        let list = |numbers: &[f64]| Key::of(numbers);
        for (one, other) in [
            (Key::of(0.0), Key::of(-0.0)),
            (Key::of(1.0), Key::of((1.0, 1.0))),
            (Key::of(None::<f64>), Key::of(Some(0.0))),
            (Key::of("a"), Key::of("ab")),
            (list(&[1.0]).and([2.0].as_slice()), list(&[]).and([1.0, 2.0].as_slice())),
            (list(&[1.0, 2.0]), list(&[2.0, 1.0])),
        ] {
            assert_ne!(one, other);
        }
        assert_eq!(Key::of(f64::NAN), Key::of(f64::NAN));
    }
}
