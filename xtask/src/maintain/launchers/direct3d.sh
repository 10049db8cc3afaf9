# A program of this machine with the libraries of vkd3d and DXVK, and Vulkan on the CPU. DXVK asks SDL for a display.
unset LD_LIBRARY_PATH
export VK_DRIVER_FILES=@USR@/share/vulkan/icd.d/lvp_icd.json
export DXVK_WSI_DRIVER=SDL3 SDL_VIDEO_DRIVER=offscreen DXVK_LOG_LEVEL=none DXVK_LOG_PATH=none DXVK_SHADER_CACHE=0
exec @LINKER@ "$@"
