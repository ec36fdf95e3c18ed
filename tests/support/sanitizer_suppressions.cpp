// Hooks of the sanitizers' run-time libraries, in every test and, where it is built with a
// sanitizer, in the program: the reports about other libraries that they ignore.

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)

// Mesa, fontconfig and D-Bus keep tables until the program ends; x265 and libaom lose some
// kilobytes with an encoder, in x265_encoder_open() and inside of libaom, after libav has closed
// it.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgallium\nleak:swrast_dri.so\nleak:libLLVM\nleak:libEGL\nleak:libfontconfig\n"
         "leak:libdbus-1\nleak:libx265\nleak:libaom\n";
}

// Mesa's rasteriser and LLVM synchronise their threads with futexes and with code compiled at run
// time, of which the thread sanitizer sees nothing: it ignores both completely, including the locks
// that LLVM's compiler takes in libgcc.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libgallium\ncalled_from_lib:swrast_dri.so\ncalled_from_lib:libLLVM\n"
         "race:libgallium\nrace:swrast_dri.so\nrace:libLLVM\n"
         "mutex:__register_frame_info\nmutex:__deregister_frame_info\nmutex:_Unwind_Find_FDE\n"
         // Not built with the sanitizer either: libav's own threads, Pango's fonts, X11's locks.
         // Races of this tree's own code inside of libav's calls to it are hidden by that, too.
         "race:libavutil\nrace:libavcodec\nrace:libfontconfig\nrace:libglib-2.0\n"
         "deadlock:libxcb\ndeadlock:libX11\nmutex:xcb_disconnect\n";
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Libraries stay loaded: SDL unloads Mesa's driver, which reports could no longer name, and which
// the thread sanitizer refuses to ignore then.
extern "C" int dlclose(void* handle);
extern "C" int dlclose(void* /*handle*/) {
  return 0;
}
#endif

// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
