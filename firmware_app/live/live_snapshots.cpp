#include "firmware_app/live/live_snapshots.h"

#include <ctime>
#include <utility>

namespace pleinair::app {

LiveSnapshots::LiveSnapshots(std::filesystem::path folder, LiveControls& controls, LiveInput& input,
                             Notify notify)
    : folder_(std::move(folder)),
      controls_(controls),
      input_(input),
      notify_(std::move(notify)),
      saver_(folder_) {}

void LiveSnapshots::update() {
  if (const auto text = input_.takeLookFile()) {
    report(saveLook(folder_, *text, std::time(nullptr)));
  }
  if (const auto saved = saver_.takeResult()) report(*saved);
  // A second snapshot waits until the first one is on disk.
  if (saver_.isBusy() || save()) return;
  if (input_.takeSnapshotRequest()) controls_.requestSnapshot();
}

void LiveSnapshots::finish() {
  do {
    if (const auto saved = saver_.awaitResult()) report(*saved);
  } while (save());
}

/// Begins to save a snapshot that was painted; returns false if there is none.
bool LiveSnapshots::save() {
  auto snapshot = controls_.takeSnapshot();
  if (!snapshot) return false;
  if (*snapshot) {
    saver_.save(**std::move(snapshot));
  } else {
    notify_(snapshot->error().message(), false);
  }
  return true;
}

void LiveSnapshots::report(const hal::Result<std::filesystem::path>& saved) {
  notify_(saved ? "saved " + saved->string() : saved.error().message(), saved.has_value());
}

}  // namespace pleinair::app
