#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera.h"
#include "hal/camera_backend.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::hal {

/// A back end as the selector sees it.
struct SelectableBackend {
  /// Shared with cameras that were abandoned in the middle of a call.
  std::shared_ptr<CameraBackend> backend;
  /// Whether its cameras are devices, which come and go: "auto" and "serial:" look among those, and
  /// the supervisor watches them for silence. Recordings and simulations are not.
  bool isDevice = true;
};

/// A camera that was started.
struct OpenedCamera {
  std::unique_ptr<Camera> camera;
  StreamFormat format;
  bool isDevice = true;
};

/// Makes a camera that tells time by that clock; keeps alive what the camera needs.
using CameraFactory = std::function<std::unique_ptr<Camera>(Clock& clock)>;
/// Puts a device's camera onto something else, such as a thread of its own (worker_camera.h).
/// Once a stop is requested, a start() that waits for the device returns.
using CameraWrapper =
    std::function<std::unique_ptr<Camera>(CameraFactory make, std::stop_token stop)>;

/// Finds the camera that a choice names among those of all back ends, and opens it:
/// - "v4l2": the back end's first that works,
/// - "v4l2:usb-046d…": by stable id, or by node: "v4l2:/dev/video0"; where no camera has that node
///   any more, the camera that was opened there is followed to its new one (by its path),
/// - "serial:ABC123": the device with that serial number, whichever back end has it,
/// - "auto": the first device that works, the back ends in their order.
/// One thread at a time.
class CameraSelector {
 public:
  /// `wrapper` is for devices only. The clock outlives the cameras. Precondition: some back end;
  /// their names differ.
  CameraSelector(std::vector<SelectableBackend> backends, std::string choice, Clock& clock,
                 CameraWrapper wrapper = {});
  ~CameraSelector() = default;
  CameraSelector(const CameraSelector&) = delete;
  CameraSelector& operator=(const CameraSelector&) = delete;

  const std::string& choice() const { return choice_; }

  /// Whether the choice names something that could be: kInvalidArgument with the choices there are
  /// where it has no known back end's name. Nothing is opened.
  Result<void> check() const;

  /// Starts the camera that the choice means. Errors: that of check(); the camera's own where one
  /// was named; where there were several or none, kNotFound or the kind they agree on, with each
  /// candidate and the reason why not.
  Result<OpenedCamera> open(const StreamRequest& request);

  /// A camera opened but was of no use: where there is a choice, it is tried after the others from
  /// now on, until it has been of use.
  void putLast(const CameraIdentity& camera);
  void wasOfUse(const CameraIdentity& camera);

  /// Devices have come or gone: a search that has not found a camera yet begins again with the
  /// first back end, rather than go on to those that take long to ask. Three times at most, since a
  /// device may come and go for ever. Any thread.
  void devicesChanged() { haveDevicesChanged_ = true; }

  /// Nothing is opened from now on, and an open() that waits for a device on a thread of its own
  /// returns at once. Any thread.
  void interrupt() { stopping_.request_stop(); }

 private:
  struct Candidate {
    const SelectableBackend* backend = nullptr;
    CameraDescription description;
  };
  struct Candidates {
    std::vector<Candidate> found;
    std::vector<Error> problems;  ///< of back ends that could not list theirs
  };
  Candidates listed(const std::vector<const SelectableBackend*>& backends) const;
  std::vector<const SelectableBackend*> devices() const;
  const SelectableBackend* backendNamed(std::string_view name) const;

  Result<OpenedCamera> openFirst(const std::vector<const SelectableBackend*>& backends,
                                 const StreamRequest& request);
  /// Tries those of one back end, but for those that are to be tried last, which are added to
  /// `lastOnes`; nothing where none works, for `reasons`.
  std::optional<OpenedCamera> openOf(const SelectableBackend& backend, const StreamRequest& request,
                                     std::vector<Candidate>& lastOnes, std::vector<Error>& reasons);
  std::optional<OpenedCamera> tried(const Candidate& candidate, const StreamRequest& request,
                                    std::vector<Error>& reasons);
  Result<OpenedCamera> openSerial(std::string_view serial, const StreamRequest& request);
  Result<OpenedCamera> openNamed(const SelectableBackend& backend, std::string_view name,
                                 const StreamRequest& request);
  Result<OpenedCamera> start(const Candidate& candidate, const StreamRequest& request);
  /// Its place among those that are tried last; −1 for others.
  std::ptrdiff_t rankOf(const Candidate& candidate) const;

  std::vector<SelectableBackend> backends_;
  std::string choice_;
  Clock& clock_;
  CameraWrapper wrapper_;
  std::stop_source stopping_;
  std::atomic<bool> haveDevicesChanged_ = false;
  std::vector<CameraIdentity> last_;
  /// the camera last opened by the node in the choice
  std::optional<CameraDescription> openedByNode_;
};

}  // namespace pleinair::hal
