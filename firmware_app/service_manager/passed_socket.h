#pragma once

#include "hal/file_descriptor.h"

namespace pleinair::app {

/// The first socket that listens among those that a service manager passed to this process
/// (sd_listen_fds(3): $LISTEN_PID, $LISTEN_FDS, descriptors from 3 on), for a server that may not
/// or cannot open one itself; nothing where none was passed. Closes the others, and takes the
/// variables out of the environment. To be called once, before other threads and other files.
hal::FileDescriptor takePassedSocket();

}  // namespace pleinair::app
