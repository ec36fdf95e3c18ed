#pragma once

#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {

/// The main() of pleinair-libcamera: serves libcamera to the program that has started it, until
/// that has ended. Gives the exit status; 2 if it was started by hand.
int runHost();

/// libcamera in processes of its own (hosted_library.h): pleinair-libcamera, which is found in the
/// folder of this program or in ../libexec/pleinair. In this process where it is not there, and in
/// builds without libcamera.
Library& hostedLibrary();

}  // namespace pleinair::hal::libcamera
