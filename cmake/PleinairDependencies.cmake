# Dependencies, each as an imported target, and the summary of optional parts.

find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tl-expected REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswresample libswscale)
# Colours of HDR and wide-gamut films (docs/decisions/0040-film-colours.md).
pkg_check_modules(ZIMG REQUIRED IMPORTED_TARGET zimg)
# Pictures in PNG, JPEG and TIFF, with a colour profile (docs/decisions/0045-written-formats.md).
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(TIFF REQUIRED IMPORTED_TARGET libtiff-4)
# Digests of records and work instructions.
pkg_check_modules(NETTLE REQUIRED IMPORTED_TARGET nettle)
# Records as one file (docs/decisions/0067-record-archive.md).
pkg_check_modules(LIBARCHIVE REQUIRED IMPORTED_TARGET libarchive)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(LIBDRM REQUIRED IMPORTED_TARGET libdrm)
pkg_check_modules(GBM REQUIRED IMPORTED_TARGET gbm)
pkg_check_modules(GLES REQUIRED IMPORTED_TARGET glesv2)
pkg_check_modules(PANGOCAIRO REQUIRED IMPORTED_TARGET pangocairo)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo cairo-pdf)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(APRILTAG REQUIRED IMPORTED_TARGET apriltag)
# STL and OBJ models (docs/decisions/0048-mesh-files.md).
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
# Models without triangles that do not show (docs/decisions/0120-simplified-models.md).
find_package(meshoptimizer REQUIRED)

# Only the header of tinygltf is used (docs/decisions/0007-tinygltf.md): Debian's library decodes
# images and opens files by itself, without limits.
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)

# Debian ships OpenCVConfig.cmake only in libopencv-dev, which depends on every module and VTK. The
# modules in use are found by themselves (docs/decisions/0002-opencv-modules.md).
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
function(pleinair_opencv_module module)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv::${module} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(opencv::${module} PROPERTIES
    IMPORTED_LOCATION "${OPENCV_${module}_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OPENCV_INCLUDE_DIR}")
endfunction()
pleinair_opencv_module(core)
pleinair_opencv_module(imgproc)
pleinair_opencv_module(calib3d)
pleinair_opencv_module(features2d)
pleinair_opencv_module(flann)
pleinair_opencv_module(objdetect)
pleinair_opencv_module(video)

# The classifiers of faces, which the program contains (docs/decisions/0132-faces.md).
set(PLEINAIR_FACE_CASCADES)
foreach(name alt alt2)
  find_file(PLEINAIR_FACE_CASCADE_${name} haarcascade_frontalface_${name}.xml
    PATHS /usr/share/opencv4/haarcascades PATH_SUFFIXES opencv4/haarcascades)
  if(NOT PLEINAIR_FACE_CASCADE_${name})
    message(FATAL_ERROR "haarcascade_frontalface_${name}.xml is missing: install opencv-data")
  endif()
  list(APPEND PLEINAIR_FACE_CASCADES "${PLEINAIR_FACE_CASCADE_${name}}")
endforeach()

# pleinair_optional(NAME STATE): adds a line to the configure summary: "in", or "not in" and why.
function(pleinair_optional name state)
  set_property(GLOBAL APPEND PROPERTY PLEINAIR_OPTIONAL "${name}|${state}")
endfunction()

# The window needs SDL.
pkg_check_modules(SDL2 QUIET IMPORTED_TARGET sdl2)
set(PLEINAIR_WINDOW OFF)
if(NOT SDL2_FOUND)
  pleinair_optional("window" "not in: libsdl2-dev is not installed")
else()
  set(PLEINAIR_WINDOW ON)
  pleinair_optional("window" "in (SDL ${SDL2_VERSION})")
endif()

# udev reports cameras that are plugged in.
pkg_check_modules(LIBUDEV QUIET IMPORTED_TARGET libudev)
if(LIBUDEV_FOUND)
  pleinair_optional("hot-plug by udev" "in (libudev ${LIBUDEV_VERSION})")
else()
  pleinair_optional("hot-plug by udev" "not in: libudev-dev is not installed")
endif()

# Sensors whose image processor libcamera drives.
pkg_check_modules(LIBCAMERA QUIET IMPORTED_TARGET libcamera)
if(LIBCAMERA_FOUND)
  pleinair_optional("cameras by libcamera" "in (libcamera ${LIBCAMERA_VERSION})")
  # Its headers include each other as <libcamera/...>, and are none of ours to warn about.
  get_target_property(libcamera_includes PkgConfig::LIBCAMERA INTERFACE_INCLUDE_DIRECTORIES)
  set_target_properties(PkgConfig::LIBCAMERA PROPERTIES
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${libcamera_includes}")
else()
  pleinair_optional("cameras by libcamera" "not in: libcamera-dev is not installed")
endif()

# Machine-vision cameras. aravis-0.8.pc names libusb-1.0, which Debian's package does not depend on.
pkg_check_modules(ARAVIS QUIET IMPORTED_TARGET aravis-0.8)
if(ARAVIS_FOUND)
  pleinair_optional("GigE Vision and USB3 Vision cameras" "in (Aravis ${ARAVIS_VERSION})")
else()
  pleinair_optional("GigE Vision and USB3 Vision cameras"
    "not in: libaravis-dev and libusb-1.0-0-dev are not installed")
endif()

# Keys on a screen without a desktop.
pkg_check_modules(LIBEVDEV QUIET IMPORTED_TARGET libevdev)
if(LIBEVDEV_FOUND)
  pleinair_optional("keys without a desktop" "in (libevdev ${LIBEVDEV_VERSION})")
else()
  pleinair_optional("keys without a desktop" "not in: libevdev-dev is not installed")
endif()

# HEIC and AVIF pictures.
pkg_check_modules(LIBHEIF QUIET IMPORTED_TARGET libheif)
if(LIBHEIF_FOUND)
  pleinair_optional("HEIC and AVIF pictures" "in (libheif ${LIBHEIF_VERSION})")
else()
  pleinair_optional("HEIC and AVIF pictures" "not in: libheif-dev is not installed")
endif()

# The status server.
pkg_check_modules(MICROHTTPD QUIET IMPORTED_TARGET libmicrohttpd)
set(PLEINAIR_STATUS_SERVER OFF)
if(MICROHTTPD_FOUND)
  set(PLEINAIR_STATUS_SERVER ON)
  pleinair_optional("status server" "in (libmicrohttpd ${MICROHTTPD_VERSION})")
else()
  pleinair_optional("status server" "not in: libmicrohttpd-dev is not installed")
endif()

if(CCACHE_PROGRAM)
  pleinair_optional("compiler cache" "in (${CCACHE_PROGRAM})")
else()
  pleinair_optional("compiler cache" "not in: ccache is not installed")
endif()
if(MOLD_PROGRAM)
  pleinair_optional("fast linker" "in (${MOLD_PROGRAM})")
else()
  pleinair_optional("fast linker" "not in: no mold, or MOLD_PROGRAM is off")
endif()
set(PLEINAIR_BENCHMARKS OFF)
if(PLEINAIR_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
  pleinair_optional("tests" "in")
  find_package(benchmark QUIET)
  find_library(OPENCV_photo_LIBRARY opencv_photo)
  if(NOT benchmark_FOUND)
    pleinair_optional("benchmarks" "not in: libbenchmark-dev is not installed")
  elseif(NOT OPENCV_photo_LIBRARY)
    pleinair_optional("benchmarks" "not in: libopencv-photo-dev, which they compare with, is not installed")
  else()
    set(PLEINAIR_BENCHMARKS ON)
    pleinair_optional("benchmarks" "in")
  endif()
else()
  pleinair_optional("tests" "not in: PLEINAIR_TESTS is off")
  pleinair_optional("benchmarks" "not in: PLEINAIR_TESTS is off")
endif()
if(EXISTS "${PLEINAIR_SHARED_DATA}/README.md")
  pleinair_optional("real test data" "in (${PLEINAIR_SHARED_DATA})")
else()
  pleinair_optional("real test data" "not in: nothing at PLEINAIR_SHARED_DATA, tests that need it skip")
endif()
if(PLEINAIR_SANITIZE)
  pleinair_optional("sanitizers" "in (${PLEINAIR_SANITIZE})")
else()
  pleinair_optional("sanitizers" "not in: PLEINAIR_SANITIZE is empty")
endif()

function(pleinair_print_summary)
  message(STATUS "pleinair ${PROJECT_VERSION}: ${CMAKE_CXX_COMPILER_ID} "
                 "${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}")
  get_property(parts GLOBAL PROPERTY PLEINAIR_OPTIONAL)
  foreach(part IN LISTS parts)
    string(REPLACE "|" ";" pair "${part}")
    list(GET pair 0 name)
    list(GET pair 1 state)
    message(STATUS "  ${name}: ${state}")
  endforeach()
endfunction()
