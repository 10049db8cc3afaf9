//! ASensorManager: a gyroscope and an accelerometer on a head that moves as the script says. Samples arrive on the
//! virtual clock, at the rate that the application has requested.
//!
//! The phone is held in landscape with its left side down (`ROTATION_90`): the device's x axis points up, its y axis to
//! the head's left, and its z axis backwards, towards the eyes.

#![allow(non_snake_case)]

use std::collections::{HashMap, VecDeque};
use std::ffi::{CStr, c_char, c_int, c_void};
use std::sync::Mutex;

use glam::{EulerRot, Quat, Vec3};

use crate::android::looper::{ALooper, Callback};
use crate::exports::{Export, System, exports};
use crate::fd::EventFd;
use crate::host::{host, lock};

/// Acceleration of gravity in m/s².
const GRAVITY: f32 = 9.81;
/// Maximum number of events in a queue. Further ones replace the oldest, as in hardware.
const FIFO: usize = 4096;
/// Period of a sensor in nanoseconds until a rate is set (`SENSOR_DELAY_NORMAL`).
const DEFAULT_PERIOD: u64 = 200_000_000;
/// Minimum period in nanoseconds.
const MIN_PERIOD: u64 = 5_000_000;

/// `ASENSOR_TYPE_ACCELEROMETER`. The other sensors are gyroscopes.
const ACCELEROMETER: c_int = 1;

/// A sensor of the device, with its `ASENSOR_TYPE_*`.
pub struct ASensor {
    kind: c_int,
    name: &'static CStr,
}

static SENSORS: [ASensor; 3] = [
    ASensor { kind: 16, name: c"Simulated gyroscope, uncalibrated" },
    ASensor { kind: 4, name: c"Simulated gyroscope" },
    ASensor { kind: ACCELEROMETER, name: c"Simulated accelerometer" },
];

/// `ASensorEvent`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ASensorEvent {
    version: i32,
    sensor: i32,
    kind: i32,
    reserved0: i32,
    timestamp: i64,
    data: [f32; 16],
    flags: u32,
    reserved1: [i32; 3],
}

const _: () = assert!(size_of::<ASensorEvent>() == 104);

/// A sensor event queue of the application.
pub struct ASensorEventQueue {
    looper: *const ALooper,
    event: EventFd,
    state: Mutex<QueueState>,
}

// SAFETY: by contract the looper outlives its queues. It is only used through functions that lock.
unsafe impl Send for ASensorEventQueue {}
// SAFETY: as above. Everything else is locked.
unsafe impl Sync for ASensorEventQueue {}

#[derive(Default)]
struct QueueState {
    enabled: HashMap<c_int, Schedule>,
    pending: VecDeque<ASensorEvent>,
}

#[derive(Clone, Copy)]
struct Schedule {
    period: u64,
    next: u64,
}

/// A turn of the head.
#[derive(Clone, Copy)]
struct Motion {
    from: Quat,
    to: Quat,
    start: u64,
    duration: u64,
}

impl Motion {
    /// Returns the rotation from head to world.
    fn orientation(&self, at: u64) -> Quat {
        if self.duration == 0 {
            return self.to;
        }
        let part = (at.saturating_sub(self.start) as f32 / self.duration as f32).clamp(0.0, 1.0);
        self.from.slerp(self.to, part * part * (3.0 - 2.0 * part))
    }
}

/// The device's sensors, and the head that the device is attached to.
pub struct Sensors {
    list: &'static [ASensor],
    motion: Mutex<Motion>,
    queues: Mutex<Vec<&'static ASensorEventQueue>>,
}

impl Sensors {
    /// Creates the sensors, or none. The head looks straight ahead.
    pub fn new(has_sensors: bool) -> Self {
        let list = if has_sensors { &SENSORS[..] } else { &[] };
        let still = Motion { from: Quat::IDENTITY, to: Quat::IDENTITY, start: 0, duration: 0 };
        Self { list, motion: Mutex::new(still), queues: Mutex::default() }
    }

    /// Turns the head to an orientation within `duration` nanoseconds from `now` on, accelerating and then
    /// decelerating. Angles are in degrees, in the order yaw (to the left), pitch (up), roll (to the left).
    pub fn turn(&self, yaw: f32, pitch: f32, roll: f32, now: u64, duration: u64) {
        self.fill(now);
        let to = Quat::from_euler(EulerRot::YXZ, yaw.to_radians(), pitch.to_radians(), roll.to_radians());
        let mut motion = lock(&self.motion);
        *motion = Motion { from: motion.orientation(now), to, start: now, duration };
    }

    /// Converts head axes to device axes.
    fn to_device(vector: Vec3) -> Vec3 {
        Vec3::new(vector.y, -vector.x, vector.z)
    }

    fn sample(&self, sensor: &ASensor, at: u64, period: u64) -> ASensorEvent {
        let motion = *lock(&self.motion);
        let head = motion.orientation(at);
        let mut data = [0.0; 16];
        let measured = if sensor.kind == ACCELEROMETER {
            head.inverse() * Vec3::new(0.0, GRAVITY, 0.0)
        } else {
            // The mean rate since the last sample, so that integrating the samples results in the orientation.
            let mut turned = motion.orientation(at - period).inverse() * head;
            if turned.w < 0.0 {
                turned = -turned;
            }
            turned.to_scaled_axis() / (period as f32 * 1e-9)
        };
        data[..3].copy_from_slice(&Self::to_device(measured).to_array());
        ASensorEvent {
            version: size_of::<ASensorEvent>() as i32,
            sensor: sensor.kind,
            kind: sensor.kind,
            reserved0: 0,
            timestamp: at as i64,
            data,
            flags: 0,
            reserved1: [0; 3],
        }
    }

    /// Adds the samples up to `now` to the queues.
    pub fn fill(&self, now: u64) {
        for queue in lock(&self.queues).iter() {
            let mut state = lock(&queue.state);
            let mut new = Vec::new();
            for sensor in self.list {
                if let Some(schedule) = state.enabled.get_mut(&sensor.kind) {
                    // After a long sleep, only deliver as many samples as the FIFO holds.
                    let backlog =
                        (now.saturating_sub(schedule.next) / schedule.period).saturating_sub(FIFO as u64);
                    schedule.next += backlog * schedule.period;
                    while schedule.next <= now {
                        let mut event = self.sample(sensor, schedule.next, schedule.period);
                        event.timestamp = host().clock.boottime_of(schedule.next) as i64;
                        new.push(event);
                        schedule.next += schedule.period;
                    }
                }
            }
            new.sort_by_key(|event| event.timestamp);
            state.pending.extend(new);
            let excess = state.pending.len().saturating_sub(FIFO);
            state.pending.drain(..excess);
            if !state.pending.is_empty() {
                queue.event.signal();
            }
        }
    }

    /// Returns when the queue with this descriptor gets its next sample.
    pub fn next_event(&self, fd: c_int) -> Option<u64> {
        let queues = lock(&self.queues);
        let queue = queues.iter().find(|queue| queue.event.raw() == fd)?;
        lock(&queue.state).enabled.values().map(|schedule| schedule.next).min()
    }
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [
            ASensorEventQueue_disableSensor, ASensorEventQueue_getEvents, ASensorEventQueue_registerSensor,
            ASensorManager_createEventQueue, ASensorManager_destroyEventQueue, ASensorManager_getDefaultSensor,
            ASensorManager_getInstanceForPackage, ASensor_getMinDelay, ASensor_getName,
        ];
    ]
}

extern "C" fn ASensorManager_getInstanceForPackage(_package: *const c_char) -> *const Sensors {
    &raw const host().sensors
}

extern "C" fn ASensorManager_getDefaultSensor(_manager: *const c_void, kind: c_int) -> *const ASensor {
    let found = host().sensors.list.iter().find(|sensor| sensor.kind == kind);
    found.map_or(std::ptr::null(), std::ptr::from_ref)
}

unsafe extern "C" fn ASensorManager_createEventQueue(
    _manager: *const c_void,
    looper: *const ALooper,
    ident: c_int,
    callback: Option<Callback>,
    data: *mut c_void,
) -> *const ASensorEventQueue {
    let queue =
        Box::leak(Box::new(ASensorEventQueue { looper, event: EventFd::new(), state: Mutex::default() }));
    // SAFETY: a live looper by contract.
    unsafe { &*looper }.add(queue.event.raw(), ident, 1, callback, data);
    let host = host();
    lock(&host.sensors.queues).push(queue);
    host.count("sensor queues", 1);
    queue
}

unsafe extern "C" fn ASensorManager_destroyEventQueue(
    _manager: *const c_void,
    queue: *mut ASensorEventQueue,
) -> c_int {
    let host = host();
    let is_known = {
        // Do not hold this lock below: a looper that determines its next event locks itself before these queues.
        let mut queues = lock(&host.sensors.queues);
        let before = queues.len();
        queues.retain(|known| !std::ptr::eq(*known, queue));
        queues.len() < before
    };
    if !is_known {
        host.violation("ASensorManager_destroyEventQueue of a queue that does not exist");
        return -libc::EINVAL;
    }
    host.count("sensor queues", -1);
    // SAFETY: the queue was made by `createEventQueue`. It was in the list, so it has not been destroyed before.
    let queue = unsafe { Box::from_raw(queue) };
    // SAFETY: by contract the looper outlives its queues.
    unsafe { &*queue.looper }.remove(queue.event.raw());
    0
}

impl ASensorEventQueue {
    fn enable(&self, sensor: &ASensor, period: Option<u64>) {
        let now = host().clock.now();
        let mut state = lock(&self.state);
        let schedule = state
            .enabled
            .entry(sensor.kind)
            .or_insert(Schedule { period: DEFAULT_PERIOD, next: now + DEFAULT_PERIOD });
        if let Some(period) = period {
            let period = period.max(MIN_PERIOD);
            *schedule = Schedule { period, next: now + period };
        }
    }
}

extern "C" fn ASensorEventQueue_registerSensor(
    queue: &ASensorEventQueue,
    sensor: &ASensor,
    period_us: i32,
    _latency_us: i64,
) -> c_int {
    queue.enable(sensor, Some(period_us.max(0) as u64 * 1000));
    0
}

extern "C" fn ASensorEventQueue_disableSensor(queue: &ASensorEventQueue, sensor: &ASensor) -> c_int {
    lock(&queue.state).enabled.remove(&sensor.kind);
    0
}

unsafe extern "C" fn ASensorEventQueue_getEvents(
    queue: &ASensorEventQueue,
    events: *mut ASensorEvent,
    count: usize,
) -> isize {
    let host = host();
    host.sensors.fill(host.clock.now());
    let mut state = lock(&queue.state);
    let taken = count.min(state.pending.len());
    for (index, event) in state.pending.drain(..taken).enumerate() {
        // SAFETY: the caller gives room for `count` events.
        unsafe { events.add(index).write(event) };
    }
    if state.pending.is_empty() {
        queue.event.clear();
    }
    taken as isize
}

extern "C" fn ASensor_getName(sensor: &ASensor) -> *const c_char {
    sensor.name.as_ptr()
}

extern "C" fn ASensor_getMinDelay(_sensor: &ASensor) -> c_int {
    (MIN_PERIOD / 1000) as c_int
}
