# A program of this machine with the libraries that Monado has, and Monado as its OpenXR runtime.
unset LD_LIBRARY_PATH
export LIBGL_ALWAYS_SOFTWARE=1
export LIBGL_DRIVERS_PATH=@USR@/lib/x86_64-linux-gnu/dri GBM_BACKENDS_PATH=@USR@/lib/x86_64-linux-gnu/gbm
export __EGL_VENDOR_LIBRARY_FILENAMES=@USR@/share/glvnd/egl_vendor.d/50_mesa.json
export XR_RUNTIME_JSON=${XR_RUNTIME_JSON:-@USR@/share/openxr/1/openxr_monado.json}
program=$(command -v "$1") || exit 127
shift
exec @LINKER@ "$program" "$@"
