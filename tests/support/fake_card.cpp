#include "tests/support/fake_card.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <unistd.h>

#include "hal/surface.h"
#include "tests/support/fake_framebuffers.h"

namespace pleinair::support {

using hal::display::Card;
using hal::display::CardState;
using hal::display::Change;
using hal::display::Commit;
using hal::display::FlipEvent;
using hal::display::GpuBuffer;
using hal::display::ObjectId;
using hal::display::Property;
using hal::display::SavedCrtc;
using hal::display::ScanOutBuffer;

namespace {

constexpr ObjectId kFirstCrtc = 100;
constexpr ObjectId kFirstConnector = 200;
constexpr ObjectId kFirstPlane = 300;
constexpr ObjectId kConsole = 900;  ///< the console's framebuffer

/// Property ids are those of a kernel: one for each name, whatever the object.
constexpr std::array<std::string_view, 15> kNames{
    "CRTC_ID", "MODE_ID", "ACTIVE", "FB_ID",  "SRC_X", "SRC_Y", "SRC_W",      "SRC_H",
    "CRTC_X",  "CRTC_Y",  "CRTC_W", "CRTC_H", "type",  "EDID",  "IN_FENCE_FD"};

ObjectId idOf(std::string_view name) {
  const auto at = std::ranges::find(kNames, name);
  assert(at != kNames.end());
  return static_cast<ObjectId>(at - kNames.begin()) + 1;
}

hal::display::Mode modeOf(const FakeMode& from) {
  hal::display::Mode mode{
      .name = std::to_string(from.size.width) + "x" + std::to_string(from.size.height),
      .size = from.size,
      .period = hal::fromSeconds(1.0 / from.hertz),
      .isPreferred = from.isPreferred,
      .isInterlaced = from.isInterlaced,
      .timings = {}};
  std::memcpy(mode.timings.data(), &from.size, sizeof(from.size));
  std::memcpy(mode.timings.data() + sizeof(from.size), &from.hertz, sizeof(from.hertz));
  return mode;
}

/// Of a plane's source, in 1/65536 px.
struct Offset {
  std::uint64_t x = 0;
  std::uint64_t y = 0;
};

struct Crtc {
  bool isActive = false;
  std::optional<FakeMode> mode;
  ObjectId framebuffer = 0;
  ObjectId connector = 0;
  ObjectId pending = 0;  ///< framebuffer of the flip that waits
  hal::TimePoint committed;
  hal::Fence fence;  ///< that it waits for
  Offset offset;     ///< of the framebuffer
};

}  // namespace

class FakeCard final : public Card {
 public:
  FakeCard(FakeCards& cards, FakeCardSpec& spec)
      : cards_(cards),
        spec_(spec),
        crtcs_(static_cast<std::size_t>(spec.crtcs)),
        framebuffers_(spec.rowPadding, spec.memoryBytes, spec.exportsDmaBufs),
        isMaster_(!spec.hasOtherMaster) {
    ++cards_.openCards;
    if (spec.hasConsole) {
      crtcs_.front() = {.isActive = true,
                        .mode = spec.connectors.front().modes.front(),
                        .framebuffer = kConsole,
                        .connector = kFirstConnector};
    }
    spec_.pixel = [this](int x, int y) {
      return framebuffers_.pixel(crtcs_.front().framebuffer, x, y);
    };
    spec_.firstPixel = [this] { return spec_.pixel(0, 0); };
    look();
  }
  ~FakeCard() override {
    spec_.firstPixel = nullptr;
    spec_.pixel = nullptr;
    --cards_.openCards;
  }
  FakeCard(const FakeCard&) = delete;
  FakeCard& operator=(const FakeCard&) = delete;

  const std::string& node() const override { return spec_.node; }
  const std::string& driver() const override { return driver_; }

  hal::Result<CardState> read(bool) override {
    if (spec_.isGone) return tl::unexpected(lost());
    CardState state;
    for (std::size_t i = 0; i < crtcs_.size(); ++i) {
      state.crtcs.push_back(
          {kFirstCrtc + static_cast<ObjectId>(i), properties({"MODE_ID", "ACTIVE"})});
    }
    for (std::size_t i = 0; i < spec_.connectors.size(); ++i) {
      const FakeConnector& from = spec_.connectors[i];
      hal::display::Connector connector{.id = kFirstConnector + static_cast<ObjectId>(i),
                                        .name = from.name,
                                        .isConnected = from.isConnected,
                                        .modes = {},
                                        .crtcs = from.crtcs,
                                        .properties = properties({"CRTC_ID", "EDID"})};
      if (from.isConnected) {
        for (const FakeMode& each : from.modes) connector.modes.push_back(modeOf(each));
      }
      for (std::size_t crtc = 0; crtc < crtcs_.size(); ++crtc) {
        if (crtcs_[crtc].isActive && crtcs_[crtc].connector == connector.id) {
          connector.properties.front().value = kFirstCrtc + crtc;
        }
      }
      state.connectors.push_back(std::move(connector));
    }
    for (int i = 0; i < spec_.crtcs * spec_.planesPerCrtc; ++i) {
      state.planes.push_back(
          {.id = kFirstPlane + static_cast<ObjectId>(i),
           .isPrimary = i % spec_.planesPerCrtc == 0,
           .crtcs = std::uint32_t{1} << (i / spec_.planesPerCrtc),
           .fourccs = {hal::kXrgb8888},
           .modifiers = spec_.planeModifiers,
           .properties = properties({"FB_ID", "CRTC_ID", "SRC_X", "SRC_Y", "SRC_W", "SRC_H",
                                     "CRTC_X", "CRTC_Y", "CRTC_W", "CRTC_H", "type"})});
      if (spec_.waitsForFences) {
        state.planes.back().properties.push_back({"IN_FENCE_FD", idOf("IN_FENCE_FD"), 0});
      }
    }
    return state;
  }

  hal::Answer isStillConnected(ObjectId connector, const hal::display::Mode& mode) override {
    if (spec_.isGone) return tl::unexpected(lost());
    const FakeConnector& at = spec_.connectors.at(connector - kFirstConnector);
    const auto isIt = [&](const FakeMode& each) { return modeOf(each).timings == mode.timings; };
    return at.isConnected && std::ranges::any_of(at.modes, isIt);
  }

  std::optional<SavedCrtc> saveCrtc(ObjectId crtc) override {
    const Crtc& of = crtcs_.at(crtc - kFirstCrtc);
    if (!of.isActive || of.framebuffer == 0) return std::nullopt;
    return SavedCrtc{.crtc = crtc,
                     .framebuffer = of.framebuffer,
                     .x = 0,
                     .y = 0,
                     .connector = of.connector,
                     .timings = modeOf(*of.mode).timings};
  }
  void restore(const SavedCrtc& before) override {
    if (spec_.isGone || !isMaster()) return;
    ++cards_.restores;
    Crtc& crtc = crtcs_.at(before.crtc - kFirstCrtc);
    endFlip(before.crtc - kFirstCrtc, cards_.clock_.now());  // a kernel waits for it
    crtc.framebuffer = before.framebuffer;
    crtc.isActive = true;
    look();
  }

  bool isMaster() override {
    isMaster_ = isMaster_ && !spec_.hasOtherMaster;
    return isMaster_;
  }
  int becomeMaster() override {
    if (spec_.hasOtherMaster) return -EBUSY;
    isMaster_ = true;
    return 0;
  }
  void dropMaster() override { isMaster_ = false; }

  int commit(std::span<const Change> changes, Commit kind) override {
    if (spec_.isGone) return -ENODEV;
    if (!isMaster()) return -EACCES;
    runTo(cards_.clock_.now());
    if (kind == Commit::kFlip) return flip(changes);
    if (kind == Commit::kTestFlip) return testFlip(changes);
    if (isSwitchingOff(changes)) return switchOff(changes.front().object);
    const int failed = modeset(changes, kind == Commit::kModeset);
    ++(kind == Commit::kTest ? cards_.tests : cards_.modesets);
    look();
    return failed;
  }

  int createBlob(std::span<const std::uint8_t> bytes, ObjectId& blob) override {
    if (spec_.isGone) return -ENODEV;
    blob = ++lastId_;
    blobs_[blob].assign(bytes.begin(), bytes.end());
    ++cards_.blobs;
    return 0;
  }
  void destroyBlob(ObjectId blob) override {
    assert(blobs_.contains(blob));
    blobs_.erase(blob);
    --cards_.blobs;
  }

  int createBuffer(hal::FrameSize size, ScanOutBuffer& buffer) override {
    if (spec_.isGone) return -ENODEV;
    if (const int failed = create(size, false, buffer); failed != 0) return failed;
    ++cards_.buffers;
    return 0;
  }
  void destroyBuffer(const ScanOutBuffer& buffer) override {
    destroy(buffer.framebuffer);
    --cards_.buffers;
  }

  int createGpuBuffer(hal::FrameSize size, std::span<const std::uint64_t> modifiers,
                      GpuBuffer& buffer) override {
    if (spec_.gpuModifiers.empty()) return -ENOSYS;
    cards_.gpuModifiersAsked.assign(modifiers.begin(), modifiers.end());
    const auto chosen = std::ranges::find_first_of(spec_.gpuModifiers, modifiers);
    if (chosen == spec_.gpuModifiers.end()) return -EINVAL;
    ScanOutBuffer memory;
    if (spec_.isGone) return -ENODEV;
    if (const int failed = create(size, true, memory); failed != 0) return failed;
    buffer = {.framebuffer = memory.framebuffer, .modifier = *chosen, .allocation = this};
    buffer.planes[0] = {
        .dmaBuf = memory.dmaBuf, .offsetBytes = 0, .strideBytes = memory.strideBytes};
    ++cards_.gpuBuffers;
    return 0;
  }
  void destroyGpuBuffer(const GpuBuffer& buffer) override {
    destroy(buffer.framebuffer);
    --cards_.gpuBuffers;
  }
  int readGpuBuffer(const GpuBuffer& buffer, hal::FrameSize size,
                    std::span<std::uint8_t> pixels) override {
    if (spec_.isGone) return -ENODEV;
    framebuffers_.read(buffer.framebuffer, size, pixels);
    if (spec_.garblesGpuBuffers) pixels[2 * static_cast<std::size_t>(size.width)] ^= 0x40U;
    return 0;
  }

  bool hasVblank(ObjectId) override { return spec_.hasVblank; }

  std::optional<hal::display::Vblank> lastVblank(ObjectId crtcId) override {
    const Crtc& crtc = crtcs_.at(crtcId - kFirstCrtc);
    if (!spec_.hasVblank || !crtc.isActive) return std::nullopt;
    const hal::Duration period = hal::fromSeconds(1.0 / crtc.mode->hertz);
    const std::int64_t count = cards_.clock_.now().time_since_epoch() / period;
    return hal::display::Vblank{.sequence = static_cast<std::uint64_t>(count),
                                .time = hal::TimePoint(count * period)};
  }

  int takeFlips(std::vector<FlipEvent>& flips) override {
    if (spec_.isGone) return -ENODEV;
    runTo(cards_.clock_.now());
    flips.insert(flips.end(), events_.begin(), events_.end());
    events_.clear();
    return 0;
  }

 private:
  int create(hal::FrameSize size, bool isGpu, ScanOutBuffer& buffer) {
    const int failed = framebuffers_.create(lastId_ + 1, size, isGpu, buffer);
    if (failed == 0) lastId_ += 2;
    return failed;
  }
  void destroy(ObjectId framebuffer) {
    for (Crtc& each : crtcs_) {
      if (each.pending == framebuffer) each.pending = 0;
    }
    framebuffers_.destroy(framebuffer);
  }

  static std::vector<Property> properties(std::initializer_list<std::string_view> names) {
    std::vector<Property> properties;
    for (const std::string_view each : names) {
      properties.push_back({std::string(each), idOf(each), each == "type" ? 1U : 0U});
    }
    return properties;
  }
  hal::Error lost() const {
    return {.kind = hal::ErrorKind::kDeviceLost, .subject = spec_.node, .problem = "is gone"};
  }

  /// The values that a commit gives an object.
  static std::optional<std::uint64_t> valueOf(std::span<const Change> changes, ObjectId object,
                                              std::string_view name) {
    for (const Change& each : changes) {
      if (each.object == object && each.property == idOf(name)) return each.value;
    }
    return std::nullopt;
  }

  static bool isSwitchingOff(std::span<const Change> changes) {
    return changes.size() == 1 && changes.front().property == idOf("ACTIVE") &&
           changes.front().value == 0;
  }

  int switchOff(ObjectId crtcId) {
    Crtc& crtc = crtcs_.at(crtcId - kFirstCrtc);
    // A kernel waits for it; a display that asks then would block.
    if (crtc.pending != 0) return -EBUSY;
    crtc.isActive = false;
    ++cards_.switchedOff;
    look();
    return 0;
  }

  /// What is seen of CRTC 0.
  void look() {
    spec_.isOn = crtcs_.front().isActive;
    spec_.panX = static_cast<int>(crtcs_.front().offset.x >> 16U);
    spec_.panY = static_cast<int>(crtcs_.front().offset.y >> 16U);
    spec_.showsConsole = spec_.isOn && crtcs_.front().framebuffer == kConsole;
  }

  int testFlip(std::span<const Change> changes) {
    ++cards_.tests;
    const auto id = static_cast<ObjectId>(changes.front().value);
    if (!framebuffers_.has(id)) return -EINVAL;
    return framebuffers_.at(id).isGpu && spec_.refusesGpuTests ? -EINVAL : 0;
  }

  int modeset(std::span<const Change> changes, bool applies) {
    const auto connector = std::ranges::find_if(changes, [](const Change& each) {
      return each.object >= kFirstConnector && each.object < kFirstPlane;
    });
    if (connector == changes.end() || connector->property != idOf("CRTC_ID")) return -EINVAL;
    const auto crtcId = static_cast<ObjectId>(connector->value);
    if (crtcId < kFirstCrtc || crtcId >= kFirstCrtc + crtcs_.size()) return -EINVAL;
    const auto blob = valueOf(changes, crtcId, "MODE_ID");
    if (!blob || !blobs_.contains(static_cast<ObjectId>(*blob))) return -EINVAL;
    if (valueOf(changes, crtcId, "ACTIVE") != 1U) return -EINVAL;
    const ObjectId plane = planeOf(changes);
    const auto framebuffer = valueOf(changes, plane, "FB_ID");
    if (!framebuffer || valueOf(changes, plane, "CRTC_ID") != crtcId) return -EINVAL;
    const auto id = static_cast<ObjectId>(*framebuffer);
    const FakeMode* mode = modeIn(connector->object, blobs_.at(static_cast<ObjectId>(*blob)));
    if (!framebuffers_.has(id) || mode == nullptr || mode->isRefused) return -EINVAL;
    // The picture fills the display, as most cards demand of a primary plane.
    const auto width = static_cast<std::uint64_t>(mode->size.width);
    const auto height = static_cast<std::uint64_t>(mode->size.height);
    const Offset offset{valueOf(changes, plane, "SRC_X").value_or(0),
                        valueOf(changes, plane, "SRC_Y").value_or(0)};
    if (!isWithin(offset, *mode, framebuffers_.at(id)) ||
        valueOf(changes, plane, "CRTC_W") != width || valueOf(changes, plane, "CRTC_H") != height ||
        valueOf(changes, plane, "SRC_W") != width << 16U ||
        valueOf(changes, plane, "SRC_H") != height << 16U) {
      return -EINVAL;
    }
    if (!applies) return 0;
    Crtc& crtc = crtcs_.at(crtcId - kFirstCrtc);
    crtc = {.isActive = true,
            .mode = *mode,
            .framebuffer = id,
            .connector = connector->object,
            .offset = offset};
    look();
    return 0;
  }

  /// Whether a framebuffer has all of what a display of this mode shows at this place of it.
  static bool isWithin(const Offset& offset, const FakeMode& mode,
                       const FakeFramebuffers::Framebuffer& buffer) {
    const std::uint64_t right = (offset.x >> 16U) + static_cast<std::uint64_t>(mode.size.width);
    const std::uint64_t bottom = (offset.y >> 16U) + static_cast<std::uint64_t>(mode.size.height);
    return right <= static_cast<std::uint64_t>(buffer.size.width) &&
           bottom <= static_cast<std::uint64_t>(buffer.size.height);
  }

  static ObjectId planeOf(std::span<const Change> changes) {
    for (const Change& each : changes) {
      if (each.object >= kFirstPlane) return each.object;
    }
    return 0;
  }

  const FakeMode* modeIn(ObjectId connector, const std::vector<std::uint8_t>& timings) const {
    for (const FakeMode& each : spec_.connectors.at(connector - kFirstConnector).modes) {
      if (std::ranges::equal(modeOf(each).timings, timings)) return &each;
    }
    return nullptr;
  }

  int flip(std::span<const Change> changes) {
    const ObjectId plane = planeOf(changes);
    const auto framebuffer = valueOf(changes, plane, "FB_ID");
    if (plane == 0 || !framebuffer) return -EINVAL;
    Crtc& crtc = crtcs_.at((plane - kFirstPlane) / static_cast<ObjectId>(spec_.planesPerCrtc));
    const auto id = static_cast<ObjectId>(*framebuffer);
    if (!crtc.isActive || !framebuffers_.has(id)) return -EINVAL;
    Offset offset = crtc.offset;
    const auto sourceX = valueOf(changes, plane, "SRC_X");
    const auto sourceY = valueOf(changes, plane, "SRC_Y");
    if ((sourceX || sourceY) && spec_.refusesPanning) return -EINVAL;
    offset = {sourceX.value_or(offset.x), sourceY.value_or(offset.y)};
    if (!isWithin(offset, *crtc.mode, framebuffers_.at(id))) return -EINVAL;
    if (crtc.pending != 0) return -EBUSY;
    if (framebuffers_.at(id).isGpu && spec_.refusesGpuFlips) return -EINVAL;
    if (std::exchange(spec_.busyFlips, std::max(0, spec_.busyFlips - 1)) > 0) return -EBUSY;
    if (std::exchange(spec_.memorylessFlips, std::max(0, spec_.memorylessFlips - 1)) > 0) {
      return -ENOMEM;
    }
    ++cards_.flips;
    cards_.changesOfFlips.push_back(changes.size());
    crtc.pending = id;
    crtc.offset = offset;
    look();
    crtc.committed = cards_.clock_.now();
    crtc.fence = hal::Fence();
    if (const auto fence = valueOf(changes, plane, "IN_FENCE_FD")) {
      if (!spec_.waitsForFences) return -EINVAL;
      crtc.fence = hal::Fence(::dup(static_cast<int>(*fence)));
      ++cards_.flipsWithFence;
    }
    if (!spec_.hasVblank) runTo(crtc.committed);
    return 0;
  }

  void runTo(hal::TimePoint now) {
    if (spec_.losesFlips) return;
    for (std::size_t i = 0; i < crtcs_.size(); ++i) {
      Crtc& crtc = crtcs_[i];
      if (crtc.pending == 0) continue;
      if (!crtc.fence.hasSignalled()) {
        crtc.committed = now;
        continue;
      }
      const hal::Duration period = hal::fromSeconds(1.0 / crtc.mode->hertz);
      const std::int64_t count = crtc.committed.time_since_epoch() / period + 1;
      const hal::TimePoint refresh =
          spec_.hasVblank ? hal::TimePoint(count * period) : crtc.committed;
      if (refresh <= now) endFlip(i, refresh);
    }
  }

  void endFlip(std::size_t i, hal::TimePoint refresh) {
    Crtc& crtc = crtcs_[i];
    if (crtc.pending == 0) return;
    const std::int64_t count =
        refresh.time_since_epoch() / hal::Duration(hal::fromSeconds(1.0 / crtc.mode->hertz));
    crtc.framebuffer = std::exchange(crtc.pending, 0);
    const auto crtcId = kFirstCrtc + static_cast<ObjectId>(i);
    const std::uint64_t sequence = spec_.hasVblank ? static_cast<std::uint64_t>(count) : 0;
    events_.push_back(
        {.crtc = crtcId, .sequence = static_cast<std::uint32_t>(sequence), .time = refresh});
    cards_.shown.push_back({.crtc = crtcId,
                            .sequence = sequence,
                            .time = refresh,
                            .firstPixel = framebuffers_.pixel(crtc.framebuffer, 0, 0)});
  }

  FakeCards& cards_;
  FakeCardSpec& spec_;
  std::string driver_ = "fake";
  std::vector<Crtc> crtcs_;
  FakeFramebuffers framebuffers_;
  std::map<ObjectId, std::vector<std::uint8_t>> blobs_;
  std::vector<FlipEvent> events_;
  ObjectId lastId_ = 1000;
  bool isMaster_ = true;
};

FakeCardSpec& FakeCards::add(FakeCardSpec spec) {
  std::string node = spec.node;
  return specs_.emplace(std::move(node), std::move(spec)).first->second;
}

std::vector<std::string> FakeCards::nodes() {
  std::vector<std::string> nodes;
  for (const auto& [node, spec] : specs_) {
    if (!spec.isGone) nodes.push_back(node);
  }
  return nodes;
}

hal::Result<std::unique_ptr<Card>> FakeCards::open(const std::string& node) {
  const auto found = specs_.find(node);
  if (found == specs_.end() || found->second.isGone) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound, .subject = node});
  }
  return std::make_unique<FakeCard>(*this, found->second);
}

}  // namespace pleinair::support
