# Monado with a simulated headset, on the CPU and without a display.
export XRT_COMPOSITOR_NULL=1 SIMULATED_ENABLE=1 XRT_NO_STDIN=1
export VK_DRIVER_FILES=@USR@/share/vulkan/icd.d/lvp_icd.json
exec @LINKER@ @USR@/bin/monado-service
