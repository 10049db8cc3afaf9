# A program with the libraries of its own Debian, its Vulkan on the CPU, and Monado as its OpenXR runtime.
unset LD_LIBRARY_PATH
export VK_DRIVER_FILES=@USR@/share/vulkan/icd.d/lvp_icd.json XR_RUNTIME_JSON=@USR@/share/openxr/1/openxr_monado.json
exec @LINKER@ @PROGRAM@ "$@"
