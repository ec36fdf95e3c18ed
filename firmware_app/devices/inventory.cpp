#include "firmware_app/devices/inventory.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace pleinair::app {

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends) {
  DeviceCameras all;
  for (const hal::SelectableBackend& each : backends) {
    hal::Result<std::vector<hal::CameraDescription>> cameras = each.backend->list();
    if (cameras) {
      // A list is kept for long, and nothing is opened from it.
      for (hal::CameraDescription& camera : *cameras) camera.kept.reset();
      std::ranges::move(*cameras, std::back_inserter(all.cameras));
    } else {
      all.problems.push_back(std::move(cameras.error()));
    }
  }
  return all;
}

void askModes(DeviceCameras& cameras, std::span<const hal::SelectableBackend> backends,
              const hal::StreamRequest& request) {
  for (hal::CameraDescription& each : cameras.cameras) {
    const auto found =
        std::ranges::find_if(backends, [&](const hal::SelectableBackend& selectable) {
          return selectable.backend->name() == each.identity.backend;
        });
    if (found == backends.end() || each.problem) continue;
    hal::Result<hal::OfferedModes> modes = found->backend->offeredModes(each.identity.id, request);
    if (!modes) {
      each.problem = std::move(modes.error());
      continue;
    }
    each.modes = std::move(modes->modes);
    each.areModesKnown = true;
    each.chosen = std::move(modes->chosen);
  }
}

std::vector<ListedKeyboard> listKeyboards(hal::KeyboardDevices& devices) {
  std::vector<ListedKeyboard> all;
  for (hal::KeyboardDescription& each : devices.list()) {
    if (!each.hasKeys) continue;
    auto opened = devices.open(each.node);
    std::optional<hal::Error> problem;
    if (!opened) problem = std::move(opened.error());
    all.push_back({.description = std::move(each), .problem = std::move(problem)});
  }
  std::ranges::stable_partition(
      all, [](const ListedKeyboard& each) { return each.description.isKeyboard; });
  return all;
}

std::vector<KindOfOutputs> listOutputs(std::span<const hal::OutputKind> kinds) {
  std::vector<KindOfOutputs> all;
  for (const hal::OutputKind& kind : kinds) {
    all.push_back({.kind = kind.name,
                   .help = kind.help,
                   .forms = kind.forms,
                   .isFile = kind.traits.writesFiles,
                   .listing = kind.list == nullptr ? hal::OutputListing{} : kind.list()});
  }
  return all;
}

}  // namespace pleinair::app
