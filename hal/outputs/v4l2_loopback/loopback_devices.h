#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal {

/// Where V4L2 devices are looked for, and what they are driven through.
struct V4l2System {
  v4l2::SystemCalls* calls = &v4l2::kernelCalls();
  std::filesystem::path nodes = "/dev";  ///< the folder of video0, video1 …
};

/// The command that makes a device which everything can read; for remedies.
inline constexpr const char* kLoadLoopback =
    "sudo modprobe v4l2loopback video_nr=50 card_label=pleinair exclusive_caps=1";

/// A V4L2 node that takes pictures, or one that could not be looked at.
struct LoopbackDevice {
  std::string node;         ///< "/dev/video50"
  std::string card;         ///< "pleinair"
  std::string driver;       ///< "v4l2 loopback", "vivid"
  bool isLoopback = false;  ///< of the module v4l2loopback
  /// It announces its output side. With exclusive_caps=1 it does so only while nobody writes to it.
  bool isWritable = false;
  bool isReadable = false;           ///< it announces its capture side
  std::vector<std::string> layouts;  ///< fourccs that it takes
  std::optional<Error> problem;  ///< why it could not be looked at; all above but `node` is open
};

/// All that take pictures, loopbacks whether somebody writes to them or not, and all that cannot be
/// looked at.
std::vector<LoopbackDevice> listLoopbacks(const V4l2System& system = {});

/// The node that a name means: "" the first loopback that takes pictures, "/dev/video50" itself
/// (also one of another driver), anything else a card's label. Errors: kNotFound,
/// kPermissionDenied, kBusy (somebody writes to it); each says what to do, and kNotFound what there
/// is.
Result<std::string> findLoopback(const std::string& name, const V4l2System& system = {});

struct OpenLoopback {
  std::string node;
  FileDescriptor descriptor;
};

/// Opens the node that a name means (findLoopback) for writing pictures to it. Errors also:
/// kNotFound (no such node), kUnsupported (its driver takes no pictures by write()).
Result<OpenLoopback> openLoopbackNode(const std::string& name, const V4l2System& system = {});

/// kBusy, with what to do: the loopback's output side is another program's.
Error loopbackInUse(const std::string& node);

/// The remedy if a node may not be opened.
inline constexpr const char* kJoinVideo =
    "join the group video: sudo usermod -aG video $USER, then log in again";

}  // namespace pleinair::hal
