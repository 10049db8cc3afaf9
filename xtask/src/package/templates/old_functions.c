// Rust's std calls `stat64` and `fstat64`, which glibc exports only since 2.33. The functions that older headers turned
// these calls into are still exported by newer versions. `gettid` exists since 2.30; std works without it, but LLD does not
// record that in the file.
#if defined(__x86_64__)
#define BASE "GLIBC_2.2.5"
#define STAT_VERSION 1
#define GETTID 186
#elif defined(__aarch64__)
#define BASE "GLIBC_2.17"
#define STAT_VERSION 0
#define GETTID 178
#endif
extern long syscall(long number, ...);
extern int old_stat(int version, const char *path, void *result);
extern int old_fstat(int version, int file, void *result);
__asm__(".symver old_stat, __xstat64@" BASE);
__asm__(".symver old_fstat, __fxstat64@" BASE);
__attribute__((visibility("hidden"))) int stat64(const char *path, void *result) {
  return old_stat(STAT_VERSION, path, result);
}
__attribute__((visibility("hidden"))) int fstat64(int file, void *result) { return old_fstat(STAT_VERSION, file, result); }
__attribute__((visibility("hidden"))) int gettid(void) { return (int)syscall(GETTID); }
