//! The connections that wait for admission, by address: there are only so many, and the oldest makes room for a new one.

use std::collections::{BTreeMap, HashMap};
use std::future;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::watch;

/// The largest number of connections that wait, from all machines.
const MOST: usize = 64;
/// The largest number of connections that wait, from one machine. A browser opens six for the files of a page.
const MAX_OF_ONE: usize = 16;

/// The places of connections that wait for admission.
#[derive(Clone, Default)]
pub struct Places(Arc<Mutex<Waiting>>);

#[derive(Default)]
struct Waiting {
    next: u64,
    /// Each connection's address, and where it is told to make room, oldest first.
    connections: BTreeMap<u64, (IpAddr, watch::Sender<bool>)>,
}

/// A place, which is freed when it is dropped.
pub struct Place {
    places: Places,
    number: u64,
    is_lost: watch::Receiver<bool>,
}

impl Places {
    /// Returns a place. If too many connections wait, the oldest of this address loses its own, or else the oldest of the
    /// address that has most.
    pub fn take(&self, address: IpAddr) -> Place {
        let mut waiting = self.waiting();
        let mut counts: HashMap<IpAddr, usize> = HashMap::new();
        waiting.connections.values().for_each(|(address, _)| *counts.entry(*address).or_default() += 1);
        let crowded = if counts.get(&address).is_some_and(|count| *count >= MAX_OF_ONE) {
            Some(address)
        } else if waiting.connections.len() >= MOST {
            counts.into_iter().max_by_key(|(_, count)| *count).map(|(address, _)| address)
        } else {
            None
        };
        let oldest = waiting.connections.iter().find(|(_, (address, _))| Some(*address) == crowded);
        if let Some(number) = oldest.map(|(number, _)| *number)
            && let Some((_, tell)) = waiting.connections.remove(&number)
        {
            tell.send_replace(true);
        }
        let (tell, is_lost) = watch::channel(false);
        let number = waiting.next;
        waiting.next += 1;
        waiting.connections.insert(number, (address, tell));
        Place { places: self.clone(), number, is_lost }
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Place {
    /// Returns a future that ends once a newer connection has taken the place. It does not hold the place.
    pub fn lost(&self) -> impl Future<Output = ()> + use<> {
        let mut is_lost = self.is_lost.clone();
        async move {
            if is_lost.wait_for(|is_lost| *is_lost).await.is_err() {
                // It was freed instead.
                future::pending::<()>().await;
            }
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.places.waiting().connections.remove(&self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures_util::FutureExt as _;

    #[test]
    fn the_oldest_connection_makes_room_for_a_new_one() {
        let places = Places::default();
        let take = |last: u8| places.take(IpAddr::from([10, 0, 0, last]));
        let is_lost = |place: &Place| place.lost().now_or_never().is_some();
        let first: Vec<_> = (0..MAX_OF_ONE).map(|_| take(1)).collect();
        let other = take(2);
        assert!(first.iter().chain([&other]).all(|place| !is_lost(place)));
        let newest = take(1);
        let lost: Vec<_> = first.iter().map(is_lost).collect();
        assert!(lost[0] && !lost[1..].contains(&true) && !is_lost(&other) && !is_lost(&newest));
        let future = newest.lost();
        drop(newest);
        assert!(future.now_or_never().is_none(), "a place that is freed is not lost");

        // Many machines: the one with most makes room.
        let others: Vec<_> = (3..=200).map(take).collect();
        assert!(first.iter().filter(|place| is_lost(place)).count() >= MAX_OF_ONE - 1);
        assert!(others.iter().filter(|place| !is_lost(place)).count() <= MOST);
        assert_eq!(places.waiting().connections.len(), MOST);
        assert!(!is_lost(others.last().unwrap()));
    }
}
