//! A swapchain of one size: its images, a view of each, and a semaphore of each that its presentation waits for.

use ash::{khr, vk};
use std::sync::Arc;

use super::{
    device::Shared,
    error::{GpuError, Named},
    surface::Surface,
};

/// A swapchain that destroys itself. An image's semaphore is its own: it is free again when the image is.
pub(super) struct Chain {
    pub loader: khr::swapchain::Device,
    pub handle: vk::SwapchainKHR,
    pub images: Vec<ChainImage>,
    pub extent: [u32; 2],
    /// Whether its images may be read back.
    pub readable: bool,
    shared: Arc<Shared>,
}

/// One image. Null handles are those not made yet.
#[derive(Default)]
pub(super) struct ChainImage {
    pub image: vk::Image,
    pub view: vk::ImageView,
    pub drawn: vk::Semaphore,
}

/// Pixels of a swapchain for a window that says `wanted` where the surface leaves the choice; `None` if there are none.
pub(super) fn extent_of(surface: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> Option<[u32; 2]> {
    let (own, least, most) = (surface.current_extent, surface.min_image_extent, surface.max_image_extent);
    let free = own.width == u32::MAX && own.height == u32::MAX;
    let side = |own, wanted: u32, least, most: u32| if free { wanted.min(most).max(least) } else { own };
    let width = side(own.width, wanted[0], least.width, most.width);
    let height = side(own.height, wanted[1], least.height, most.height);
    // A minimised window has no pixels, even where the least extent would be one.
    (width > 0 && height > 0 && wanted.iter().all(|&side| side > 0)).then_some([width, height])
}

impl Chain {
    /// As the surface is now.
    pub fn new(
        shared: &Arc<Shared>,
        surface: &Surface,
        format: vk::SurfaceFormatKHR,
        (able, extent): (&vk::SurfaceCapabilitiesKHR, [u32; 2]),
    ) -> Result<Self, GpuError> {
        let loader = khr::swapchain::Device::new(&shared.instance.handle, &shared.device);
        let readable = able.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_SRC);
        let mut usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        if readable {
            usage |= vk::ImageUsageFlags::TRANSFER_SRC;
        }
        let opaque = able.supported_composite_alpha.contains(vk::CompositeAlphaFlagsKHR::OPAQUE);
        let alpha = if opaque { vk::CompositeAlphaFlagsKHR::OPAQUE } else { vk::CompositeAlphaFlagsKHR::INHERIT };
        let most = if able.max_image_count == 0 { u32::MAX } else { able.max_image_count };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.handle)
            .min_image_count((able.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(vk::Extent2D { width: extent[0], height: extent[1] })
            .image_array_layers(1)
            .image_usage(usage)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(able.current_transform)
            .composite_alpha(alpha)
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true);
        // SAFETY: the surface lives as long as the device; whoever asks has dropped the chain before.
        let handle = unsafe { loader.create_swapchain(&info, None) }.named("vkCreateSwapchainKHR")?;
        let mut chain = Self { loader, handle, images: Vec::new(), extent, readable, shared: shared.clone() };
        // SAFETY: the swapchain was just made.
        let images = unsafe { chain.loader.get_swapchain_images(chain.handle) }.named("vkGetSwapchainImagesKHR")?;
        for image in images {
            chain.add(image, format.format)?;
        }
        Ok(chain)
    }

    fn add(&mut self, image: vk::Image, format: vk::Format) -> Result<(), GpuError> {
        self.images.push(ChainImage { image, ..Default::default() });
        let Some(made) = self.images.last_mut() else { return Ok(()) };
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(WHOLE);
        let device = &self.shared.device;
        // SAFETY: the image is the swapchain's; both handles are owned by the chain as they come.
        unsafe {
            made.view = device.create_image_view(&info, None).named("vkCreateImageView")?;
            made.drawn = device.create_semaphore(&Default::default(), None).named("vkCreateSemaphore")?;
        }
        self.shared.name(image, "window");
        Ok(())
    }
}

/// All of a swapchain's image.
pub(super) const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Drop for Chain {
    fn drop(&mut self) {
        // SAFETY: nothing that uses the images is pending after the wait; null handles are ignored.
        unsafe {
            let _ = self.shared.device.device_wait_idle();
            for made in self.images.drain(..) {
                self.shared.device.destroy_image_view(made.view, None);
                self.shared.device.destroy_semaphore(made.drawn, None);
            }
            self.loader.destroy_swapchain(self.handle, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(own: [u32; 2]) -> vk::SurfaceCapabilitiesKHR {
        let of = |[width, height]: [u32; 2]| vk::Extent2D { width, height };
        vk::SurfaceCapabilitiesKHR::default()
            .current_extent(of(own))
            .min_image_extent(of([1, 1]))
            .max_image_extent(of([4096, 2048]))
    }

    #[test]
    fn the_surface_decides_its_size_where_it_has_one() {
        assert_eq!(extent_of(&surface([640, 480]), [100, 100]), Some([640, 480]));
        assert_eq!(extent_of(&surface([u32::MAX; 2]), [100, 9000]), Some([100, 2048]));
    }

    #[test]
    fn a_minimised_window_has_no_pixels() {
        assert_eq!(extent_of(&surface([0, 0]), [640, 480]), None);
        assert_eq!(extent_of(&surface([u32::MAX; 2]), [0, 480]), None);
    }
}
