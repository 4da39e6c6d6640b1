//! A device and what it can do.

use std::sync::{Arc, Mutex, PoisonError};

use crate::error::{Error, Result};
use wgpu::{
    Adapter, AdapterInfo, Device, DeviceDescriptor, Features, Instance, InstanceDescriptor, InstanceFlags, Limits,
    Queue, RequestAdapterOptions,
};

/// A graphics device with its queue. Copies are the same device.
#[derive(Debug, Clone)]
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    about: AdapterInfo,
    trouble: Arc<Trouble>,
}

/// What is wrong with a device.
#[derive(Default)]
struct Trouble {
    /// What it first complained of.
    complaint: Mutex<Option<String>>,
    /// Who wants to know at once.
    listener: Mutex<Option<Listener>>,
}

type Listener = Arc<dyn Fn() + Send + Sync>;

impl Trouble {
    fn note(&self, text: String) {
        self.complaint.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
        let listener = self.listener.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(listener) = listener {
            listener();
        }
    }
}

impl std::fmt::Debug for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Trouble").field("complaint", &self.complaint).finish_non_exhaustive()
    }
}

impl Gpu {
    /// The best adapter of the machine, without a window.
    ///
    /// Software adapters are taken if there are no others.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if there is none.
    pub async fn headless() -> Result<Self> {
        let mut about = InstanceDescriptor::new_without_display_handle_from_env();
        about.flags = InstanceFlags::from_env_or_default();
        let instance = Instance::new(about);
        let options = RequestAdapterOptions::default();
        let adapter = instance.request_adapter(&options).await.map_err(|e| Error::NoAdapter(e.to_string()))?;
        Self::from_adapter(&adapter).await
    }

    /// A device of an adapter, with what rilievo can use of it.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if the adapter has no device to give.
    pub async fn from_adapter(adapter: &Adapter) -> Result<Self> {
        let request = Self::request(adapter);
        let (device, queue) = adapter.request_device(&request).await.map_err(|e| Error::NoAdapter(e.to_string()))?;
        Ok(Self::from_device(device, queue, adapter.get_info()))
    }

    /// What to ask of an adapter whose device is shared with others: everything that the oldest web API has, textures as large as the
    /// adapter allows, and timestamps where there are any.
    pub fn request(adapter: &Adapter) -> DeviceDescriptor<'static> {
        let limits = Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
        DeviceDescriptor {
            label: Some("rilievo"),
            required_features: adapter.features() & Features::TIMESTAMP_QUERY,
            required_limits: limits,
            ..DeviceDescriptor::default()
        }
    }

    /// A device that was made elsewhere, as by [`Gpu::request`].
    ///
    /// Errors of the device are kept from now on, and given by [`Gpu::check`]: wgpu itself would end the program.
    pub fn from_device(device: Device, queue: Queue, about: AdapterInfo) -> Self {
        let trouble = Arc::new(Trouble::default());
        let (lost, wrong) = (Arc::clone(&trouble), Arc::clone(&trouble));
        device.set_device_lost_callback(move |reason, message| lost.note(format!("{reason:?}: {message}")));
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| wrong.note(error.to_string())));
        Self { device, queue, about, trouble }
    }

    /// Calls `listener`, on whatever thread, when [`Gpu::check`] has something to say: for who draws only when something changes.
    pub fn on_trouble(&self, listener: impl Fn() + Send + Sync + 'static) {
        *self.trouble.listener.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(listener));
    }

    /// Whether the device still works.
    ///
    /// # Errors
    /// [`Error::Device`] with what it first complained of.
    pub fn check(&self) -> Result<()> {
        match self.trouble.complaint.lock().unwrap_or_else(PoisonError::into_inner).as_ref() {
            Some(text) => Err(Error::Device(text.clone())),
            None => Ok(()),
        }
    }

    /// Lets callbacks run that are due.
    pub(crate) fn poll(&self) {
        // What is wrong with the device comes by its own callback.
        let _ = self.device.poll(wgpu::PollType::Poll);
    }

    /// The adapter, its driver and the API, for people.
    pub fn name(&self) -> String {
        let AdapterInfo { name, driver, driver_info, backend, .. } = &self.about;
        let driver: Vec<&str> = [driver.as_str(), driver_info].into_iter().filter(|s| !s.is_empty()).collect();
        match driver.is_empty() {
            true => format!("{name} by {backend}"),
            false => format!("{name} by {backend} ({})", driver.join(" ")),
        }
    }

    /// The adapter's own name.
    pub fn short_name(&self) -> &str {
        &self.about.name
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Its queue.
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// The longest side of a texture.
    pub fn max_side(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Refuses what is larger than the device holds.
    pub(crate) fn expect_side(
        &self,
        what: &'static str,
        (width, height): (u32, u32),
        remedy: &'static str,
    ) -> Result<()> {
        let (needs, limit) = (width.max(height), self.max_side());
        if needs > limit {
            return Err(Error::Limit { what, needs: needs.into(), limit: limit.into(), remedy });
        }
        Ok(())
    }

    /// Waits until the device has done what it was given; on the web there is no waiting, and callbacks come by themselves.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost.
    pub fn wait(&self) -> Result<()> {
        #[cfg(not(target_arch = "wasm32"))]
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| Error::Device(e.to_string()))?;
        Ok(())
    }
}
