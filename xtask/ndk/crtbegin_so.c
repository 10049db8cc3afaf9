/* Linked first into every shared library. __dso_handle is the library's own address by which it registers
   destructors; they run when the library is unloaded. */

void __cxa_finalize(void *dso);

__attribute__((visibility("hidden"))) void *const __dso_handle = (void *)&__dso_handle;

__attribute__((destructor)) static void run_destructors(void) { __cxa_finalize((void *)&__dso_handle); }

/* By this note Android's linker knows the API level that the library was made for. */
__attribute__((section(".note.android.ident"), aligned(4), used)) static const struct {
  int name_size, content_size, type;
  char name[8];
  int api;
} api_note = {sizeof "Android", sizeof(int), 1, "Android", __ANDROID_API__};
