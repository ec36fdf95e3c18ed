# Dependencies, each as an imported target, and the summary of optional parts.

find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tl-expected REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswscale)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(GBM REQUIRED IMPORTED_TARGET gbm)
pkg_check_modules(GLES REQUIRED IMPORTED_TARGET glesv2)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(APRILTAG REQUIRED IMPORTED_TARGET apriltag)

# Debian's OpenCVConfig.cmake comes only with libopencv-dev, which pulls in every module and VTK; the
# few modules that are used come without it.
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

if(PLEINAIR_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
  include(GoogleTest)
endif()

# pleinair_optional(NAME text): one line of the configure summary.
function(pleinair_optional name state)
  set_property(GLOBAL APPEND PROPERTY PLEINAIR_OPTIONAL "${name}|${state}")
endfunction()

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
