#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/devices/inventory.h"
#include "firmware_app/doctor/frame_import_trial.h"
#include "firmware_app/doctor/scan_out_trial.h"
#include "hal/error.h"
#include "hal/output_kind.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/v4l2_loopback/loopback_devices.h"
#include "pipeline/gpu/context/egl_context.h"

namespace pleinair::app::doctor {

/// Something that the configuration asks for.
struct RequestedPart {
  std::string part;   ///< "camera", "output", "scene", "style", "status"
  std::string value;  ///< as configured
  std::optional<hal::Error> problem = std::nullopt;  ///< why it cannot be had
  bool isChosen = true;   ///< else a default, or something that is waited for: only a warning
  bool isDevice = false;  ///< part of the machine, and neither a file nor a folder
};

/// The checks' access to the machine; tests replace it. One thread.
struct Probes {
  /// The text of a small file without white space at its end; nothing where it cannot be read.
  std::function<std::optional<std::string>(const std::filesystem::path&)> read;
  /// The entries of a folder, sorted; none if there is no such folder.
  std::function<std::vector<std::filesystem::path>(const std::filesystem::path&)> list;
  /// Whether it may be read and written (a folder: entered, too): 0, or errno.
  std::function<int(const std::filesystem::path&)> access;
  std::function<std::optional<std::uint64_t>(const std::filesystem::path&)> freeBytes;
  /// The soft limit of RLIMIT_…
  std::function<std::uint64_t(int)> limit;
  /// Makes a context and lets it go.
  std::function<hal::Result<gpu::ContextInfo>()> graphics;
  /// Tries whether the GPU reads memory that it shares with a camera.
  std::function<FrameImportVerdict()> frameImport;
  std::function<DeviceCameras()> cameras;
  /// Of camera.size and camera.rate; null: not known.
  std::function<double()> askedPixelsPerSecond;
  std::function<std::vector<hal::LoopbackDevice>()> loopbacks;
  std::function<hal::OutputListing()> displays;
  /// Why the first display that is plugged in could not be taken now.
  std::function<std::optional<hal::Error>()> displayProblem;
  /// When the first display that is plugged in shows pictures.
  std::function<hal::Result<hal::DisplayTiming>()> displayTiming;
  /// How pictures would reach the memory of the first display that is plugged in.
  std::function<ScanOutVerdict()> scanOut;
  std::function<std::vector<ListedKeyboard>()> keyboards;
  /// The error of the configuration, in a line; nothing where it is valid.
  std::function<std::optional<std::string>()> configurationError;
  /// The parts that the configuration asks for; none where it is not valid.
  std::function<std::vector<RequestedPart>()> requested;
  std::filesystem::path snapshots;  ///< the folder that snapshots go to
};

/// This machine's, but for `cameras`, `askedPixelsPerSecond`, `configurationError`, `requested` and
/// `snapshots`.
Probes systemProbes();

}  // namespace pleinair::app::doctor
