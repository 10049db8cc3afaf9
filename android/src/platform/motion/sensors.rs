//! Gyroscope and accelerometer.

use std::ffi::{CStr, c_int};
use std::ptr::{self, NonNull};

use glam::Vec3;
use ndk_sys as ffi;
use yoro_lenses::MotionSample;

const ACCELEROMETER: c_int = 1;
const GYROSCOPE: c_int = 4;
const GYROSCOPE_UNCALIBRATED: c_int = 16;
/// The shortest period allowed without a permission. From Android 12 on, a faster sensor gives no samples at all.
const SHORTEST_PERIOD_US: i32 = 5_000;
/// An arbitrary identifier that the looper returns for sensor events.
const LOOPER_IDENT: c_int = 1;
/// Number of events that are read at once.
const BATCH: usize = 32;

/// The motion sensors, running until this is dropped. It belongs to the thread that created it.
pub struct Sensors {
    manager: NonNull<ffi::ASensorManager>,
    queue: NonNull<ffi::ASensorEventQueue>,
    running: Vec<NonNull<ffi::ASensor>>,
}

impl Sensors {
    /// Starts the available sensors for a thread with a looper, and logs which they are.
    pub fn start(looper: NonNull<ffi::ALooper>) -> Option<Sensors> {
        // SAFETY: the name is null-terminated.
        let manager =
            NonNull::new(unsafe { ffi::ASensorManager_getInstanceForPackage(c"io.github.yoro".as_ptr()) })?;
        // SAFETY: manager and looper are live; events are reported by the looper's return value, without a callback.
        let queue = unsafe {
            ffi::ASensorManager_createEventQueue(
                manager.as_ptr(),
                looper.as_ptr(),
                LOOPER_IDENT,
                None,
                ptr::null_mut(),
            )
        };
        let mut sensors = Sensors { manager, queue: NonNull::new(queue)?, running: Vec::new() };
        if !sensors.enable(GYROSCOPE_UNCALIBRATED) && !sensors.enable(GYROSCOPE) {
            log::warn!("this device has no gyroscope: the picture does not follow the head");
        }
        if !sensors.enable(ACCELEROMETER) {
            log::warn!("this device has no accelerometer: the horizon may tilt, and the direction drifts");
        }
        Some(sensors)
    }

    fn enable(&mut self, kind: c_int) -> bool {
        // SAFETY: the manager is live; null means that there is no such sensor.
        let sensor = unsafe { ffi::ASensorManager_getDefaultSensor(self.manager.as_ptr(), kind) };
        let Some(sensor) = NonNull::new(sensor.cast_mut()) else { return false };
        // SAFETY: queue and sensor are live.
        let (period, status) = unsafe {
            let period = ffi::ASensor_getMinDelay(sensor.as_ptr()).max(SHORTEST_PERIOD_US);
            (period, ffi::ASensorEventQueue_registerSensor(self.queue.as_ptr(), sensor.as_ptr(), period, 0))
        };
        // SAFETY: the sensor is live; its name is a static string or null.
        let name = unsafe {
            let name = ffi::ASensor_getName(sensor.as_ptr());
            if name.is_null() { "unnamed".into() } else { CStr::from_ptr(name).to_string_lossy() }
        };
        if status < 0 {
            log::warn!(
                "the sensor {name} cannot be started (status {status}): close other applications that use it"
            );
            return false;
        }
        log::info!("sensor: {name}, type {kind}, every {:.1} ms", period as f32 * 1e-3);
        self.running.push(sensor);
        true
    }

    /// Calls `take` with the samples that have arrived and their times in nanoseconds.
    pub fn drain(&mut self, mut take: impl FnMut(MotionSample, i64)) {
        // SAFETY: all zeros is a valid event.
        let mut events: [ffi::ASensorEvent; BATCH] = unsafe { std::mem::zeroed() };
        loop {
            // SAFETY: the queue is live, and the buffer has the given length.
            let count =
                unsafe { ffi::ASensorEventQueue_getEvents(self.queue.as_ptr(), events.as_mut_ptr(), BATCH) };
            let Ok(count @ 1..) = usize::try_from(count) else { return };
            for event in events.iter().take(count) {
                // SAFETY: the values of these sensors are floats.
                let data = unsafe { event.__bindgen_anon_1.__bindgen_anon_1.data };
                let vector = |at: usize| Vec3::new(data[at], data[at + 1], data[at + 2]);
                let sample = match event.type_ {
                    ACCELEROMETER => MotionSample::Accelerometer(vector(0)),
                    GYROSCOPE => MotionSample::Gyroscope(vector(0)),
                    GYROSCOPE_UNCALIBRATED => {
                        MotionSample::GyroscopeUncalibrated { rate: vector(0), bias: vector(3) }
                    }
                    _ => continue,
                };
                take(sample, event.timestamp);
            }
        }
    }
}

impl Drop for Sensors {
    fn drop(&mut self) {
        // SAFETY: the queue and the sensors are live, and the queue is not used afterwards.
        unsafe {
            for sensor in &self.running {
                ffi::ASensorEventQueue_disableSensor(self.queue.as_ptr(), sensor.as_ptr());
            }
            ffi::ASensorManager_destroyEventQueue(self.manager.as_ptr(), self.queue.as_ptr());
        }
    }
}
