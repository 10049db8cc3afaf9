//! The number of connections that wait for admission, by address, so that one machine cannot keep others from
//! connecting.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The largest number of connections that wait, from all machines.
const MOST: usize = 64;
/// The largest number of connections that wait, from one machine. A browser opens six for the files of a page.
const MOST_OF_ONE: usize = 16;

/// The places of connections that wait for admission.
#[derive(Clone, Default)]
pub struct Places(Arc<Mutex<HashMap<IpAddr, usize>>>);

/// A place, which is freed when it is dropped.
pub struct Place(Places, IpAddr);

impl Places {
    /// Returns a place; `None` if there are too many connections.
    pub fn take(&self, address: IpAddr) -> Option<Place> {
        let mut counts = self.counts();
        if counts.values().sum::<usize>() >= MOST || counts.get(&address).is_some_and(|n| *n >= MOST_OF_ONE) {
            return None;
        }
        *counts.entry(address).or_default() += 1;
        Some(Place(self.clone(), address))
    }

    fn counts(&self) -> MutexGuard<'_, HashMap<IpAddr, usize>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut counts = self.0.counts();
        if let Some(count) = counts.get_mut(&self.1) {
            *count -= 1;
            if *count == 0 {
                counts.remove(&self.1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_machine_cannot_take_all_connections() {
        let places = Places::default();
        let take = |last: u8| places.take(IpAddr::from([10, 0, 0, last]));
        let mut taken: Vec<_> = std::iter::from_fn(|| take(1)).collect();
        assert_eq!(taken.len(), MOST_OF_ONE);
        assert!(take(2).is_some(), "another machine comes in");
        taken.pop();
        assert!(take(1).is_some(), "a place is free again");
        let others: Vec<_> = (2..=200).filter_map(take).collect();
        assert_eq!(taken.len() + others.len(), MOST);
    }
}
