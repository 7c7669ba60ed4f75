//! What the validation layers say, collected: in tests one message is a failure.

use ash::{ext::debug_utils, vk};
use std::{
    ffi::{CStr, c_void},
    io::Write,
    sync::Mutex,
};

use super::error::{GpuError, Named};

/// The messenger and what it heard. Dropped before the instance.
pub(super) struct Messages {
    loader: debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    heard: Box<Mutex<Vec<String>>>,
}

impl Messages {
    pub fn new(entry: &ash::Entry, instance: &ash::Instance) -> Result<Self, GpuError> {
        let heard = Box::new(Mutex::new(Vec::new()));
        let loader = debug_utils::Instance::new(entry, instance);
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
            )
            .pfn_user_callback(Some(hear))
            .user_data(&*heard as *const Mutex<Vec<String>> as *mut c_void);
        // SAFETY: `heard` is boxed and outlives the messenger, which `drop` destroys first.
        let messenger =
            unsafe { loader.create_debug_utils_messenger(&info, None) }.named("vkCreateDebugUtilsMessengerEXT")?;
        Ok(Self { loader, messenger, heard })
    }

    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.heard.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    }
}

impl Drop for Messages {
    fn drop(&mut self) {
        // SAFETY: created by this loader, destroyed once.
        unsafe { self.loader.destroy_debug_utils_messenger(self.messenger, None) }
        for text in self.take() {
            let _ = writeln!(std::io::stderr(), "validation: {text}");
        }
    }
}

// SAFETY: called by Vulkan alone, with what the specification promises.
unsafe extern "system" fn hear(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan hands valid data for the length of the call; `user` is the boxed list of `Messages`.
    unsafe {
        if let (Some(data), Some(heard)) = (data.as_ref(), (user as *const Mutex<Vec<String>>).as_ref())
            && !data.p_message.is_null()
        {
            let text = CStr::from_ptr(data.p_message).to_string_lossy().into_owned();
            if let Ok(mut list) = heard.lock() {
                list.push(text);
            }
        }
    }
    vk::FALSE
}
