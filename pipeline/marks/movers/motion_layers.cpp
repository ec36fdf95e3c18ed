#include "pipeline/marks/movers/motion_layers.h"

#include <array>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/movers/background_binding.h"
#include "pipeline/marks/movers/front_movers.h"
#include "pipeline/marks/movers/in_place_movers.h"
#include "pipeline/marks/movers/mover_motion.h"

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;
using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/marks/movers/shaders/";
constexpr hal::Duration kStandingHold = std::chrono::milliseconds(500);
constexpr float kFreshSeconds = 0.3F;
/// Since the camera began to look: so long what is remembered may be a mover that stood there.
constexpr hal::Duration kDoubted = std::chrono::seconds(3);
constexpr unsigned kTurns = 2;  // shaders/motion_layers_tally.glsl
constexpr std::size_t kTallied = 3;
constexpr std::size_t kPartBytes = 60;  // shaders/mover_parts.glsl
/// Words of the buffer, as in shaders/busy_blocks.glsl: before those of blocks, and of a block.
constexpr std::size_t kBusyWords = 21;
constexpr std::size_t kBusyWordsOfBlock = 3;
constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                               GL_SHADER_STORAGE_BARRIER_BIT;

constexpr GLbitfield kListed = kStored | GL_COMMAND_BARRIER_BIT;

hal::FrameSize cellsOf(hal::FrameSize full) {
  constexpr int kSide = MotionLayers::kCellPixels;
  return {(full.width + kSide - 1) / kSide, (full.height + kSide - 1) / kSide};
}

hal::FrameSize blocksOf(hal::FrameSize cells) {
  constexpr int kBlockCells = MotionLayers::kBlockCells;  // shaders/layer_blocks.glsl
  return {(cells.width + kBlockCells - 1) / kBlockCells,
          (cells.height + kBlockCells - 1) / kBlockCells};
}

}  // namespace

struct MotionLayers::State {
  State(const gpu::ShaderLibrary& library, hal::FrameSize fullSize)
      : full(fullSize),
        size(cellsOf(full)),
        compare(library.compute(kShaders + "motion_layers.comp")),
        compareAtRest(library.compute(kShaders + "motion_layers.comp", {{"AT_REST"}})),
        markNear(library.compute(kShaders + "motion_layers_near_mark.comp")),
        listNear(library.compute(kShaders + "motion_layers_near_list.comp")),
        compareNear(library.compute(kShaders + "motion_layers_near.comp")),
        markBusy(library.compute(kShaders + "motion_layers_busy_mark.comp")),
        listBusy(library.compute(kShaders + "motion_layers_busy_list.comp")),
        settle(library.compute(kShaders + "motion_layers_settle.comp")),
        settleAtRest(library.compute(kShaders + "motion_layers_settle.comp", {{"AT_REST"}})),
        findGround(library.compute(kShaders + "motion_layers_ground.comp")),
        join(library.compute(kShaders + "motion_layers_join.comp")),
        carry(library.compute(kShaders + "mover_carry.comp")),
        countParts(library.compute(kShaders + "mover_parts_count.comp")),
        findParts(library.compute(kShaders + "mover_parts.comp")),
        number(library.compute(kShaders + "mover_numbers.comp")),
        motionOfMovers(library, blocksOf(size)),
        inPlace(library, blocksOf(size)),
        front(library, size),
        candidates(TextureFormat::kRgba8, size),
        evidence(TextureFormat::kRgba16f, size),
        ground(TextureFormat::kRgba16f, blocksOf(size)),
        carried(TextureFormat::kRgba8, size),
        numbers(TextureFormat::kRgba8, blocksOf(size)),
        parts(kPartBytes * static_cast<std::size_t>(blocksOf(size).pixels()),
              gpu::BufferUsage::kDynamic),
        tally(kTallied * kTurns * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        busy(sizeof(std::uint32_t) *
                 (kBusyWords +
                  kBusyWordsOfBlock * static_cast<std::size_t>(blocksOf(size).pixels())),
             gpu::BufferUsage::kDynamic),
        binding(full),
        nothing(TextureFormat::kRgba16f, {1, 1}) {
    tally.write(std::vector<std::byte>(tally.sizeBytes()));
    busy.write(std::vector<std::byte>(busy.sizeBytes()));
    for (std::size_t i = 0; i < 2; ++i) {
      pictures.at(i) = {TextureFormat::kRgba8, size, TextureFilter::kLinear};
      labels.at(i) = {TextureFormat::kRgba16f, size, TextureFilter::kLinear};
      shares.at(i) = {TextureFormat::kRgba8, size, TextureFilter::kLinear};
      backgrounds.at(i) = {TextureFormat::kRgba16f, size, TextureFilter::kLinear};
      activities.at(i) = {TextureFormat::kR32f, size};
      noMovers.at(i) = gpu::RenderTarget({&shares.at(i), &carried});
    }
  }

  hal::FrameSize full;
  hal::FrameSize size;
  gpu::Program compare;
  gpu::Program compareAtRest;
  gpu::Program markNear;
  gpu::Program listNear;
  gpu::Program compareNear;
  gpu::Program markBusy;
  gpu::Program listBusy;
  gpu::Program settle;
  gpu::Program settleAtRest;
  gpu::Program findGround;
  gpu::Program join;
  gpu::Program carry;
  gpu::Program countParts;
  gpu::Program findParts;
  gpu::Program number;
  MoverMotion motionOfMovers;
  InPlaceMovers inPlace;
  FrontMovers front;
  gpu::Texture candidates;
  gpu::Texture evidence;
  gpu::Texture ground;
  gpu::Texture carried;  // before labels are told apart: what InPlaceMovers has found
  gpu::Texture numbers;
  gpu::Buffer parts;
  std::array<gpu::Texture, 2> pictures;
  std::array<gpu::Texture, 2> labels;
  std::array<gpu::Texture, 2> shares;
  std::array<gpu::Texture, 2> backgrounds;
  std::array<gpu::Texture, 2> activities;
  std::array<gpu::RenderTarget, 2> noMovers;  // of shares and carried, to clear them
  gpu::Buffer tally;
  gpu::Buffer busy;  // shaders/busy_blocks.glsl
  BackgroundBinding binding;
  gpu::Texture nothing;  // bound where nothing is read
  std::size_t now = 0;   // which of the two are this frame's
  unsigned turn = 0;
  hal::FrameSize frameSize;  // of the last update
  std::uint64_t last = 0;    // the frame of the last update
  hal::TimePoint lastTime;
  float lastStep = 0.0F;  // s; moverMotion is over it
  bool hasPast = false;
  bool hasActivity = false;  // whether that of the background has been learned
  bool isStanding = false;
  bool hasFront = false;  // whether the last frame had models
  hal::Duration sinceStanding = kStandingHold;
  hal::Duration sinceFirst{0};  // since the first frame

  const gpu::Texture& moverMotion() const { return motionOfMovers.motion(); }
  glm::ivec2 cells() const { return {size.width, size.height}; }
  glm::ivec2 blocks() const { return {numbers.size().width, numbers.size().height}; }
  void forgetFront() {
    hasFront = false;
    front.reset();
  }
  gpu::Program& begin(gpu::Program& program, const scene::ArFrame& frame, const MotionField& motion,
                      float stepSeconds) const;
  /// Fills what both of the passes read that compare cells with the past.
  gpu::Program& beginToCompare(gpu::Program& program, const scene::ArFrame& frame,
                               const MotionField& motion, float stepSeconds);
  BusyBlocks busyBlocks() const { return {&busy, blocks()}; }
  /// Binds the blocks that are listed. Precondition: the program is in use.
  gpu::Program& bindBusy(gpu::Program& program) const {
    if (program.hasUniform("turn")) program.set("turn", turn);
    return busyBlocks().bind(program);
  }
  void dispatchBusy(gpu::Program& program, BlockCommand command) const {
    busyBlocks().dispatch(program, kStored, command);
  }
  /// Which mover each cell of this frame's labels belongs to.
  void tellApart(const scene::ArFrame& frame, const MotionField& motion, float motionScale);
};

gpu::Program& MotionLayers::State::begin(gpu::Program& program, const scene::ArFrame& frame,
                                         const MotionField& motion, float stepSeconds) const {
  program.use();
  motion.bind(program);
  binding.bind(program, frame, motion, last);
  return program.storage("Tally", tally).set("turn", turn).set("stepSeconds", stepSeconds);
}

gpu::Program& MotionLayers::State::beginToCompare(gpu::Program& program,
                                                  const scene::ArFrame& frame,
                                                  const MotionField& motion, float stepSeconds) {
  const std::size_t before = 1 - now;
  begin(program, frame, motion, stepSeconds);
  return bindBusy(program)
      .texture("picture", frame.camera())
      .texture("lastPicture", pictures.at(before))
      .texture("background", backgrounds.at(before))
      .texture("backgroundActivity", activities.at(before))
      .texture("labels", labels.at(before))
      .texture("motion", motion.backward())
      .set("hasPast", hasPast ? 1 : 0)
      .set("noise", cellNoise(motion))
      .image("candidates", candidates, ImageAccess::kWrite)
      .image("evidence", evidence, ImageAccess::kWrite);
}

void MotionLayers::State::tellApart(const scene::ArFrame& frame, const MotionField& motion,
                                    float motionScale) {
  const std::size_t before = 1 - now;
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);  // written as images before
  noMovers.at(now).beginDiscarding();
  for (const int each : {0, 1}) noMovers.at(now).clearColour(each, glm::vec4(0.0F));
  motion.bind(carry.use());
  binding.bind(carry, frame, motion, last);
  bindBusy(carry)
      .texture("labels", labels.at(now))
      .texture("picture", pictures.at(now))
      .texture("lastPicture", pictures.at(before))
      .texture("moverShares", shares.at(before))
      .texture("moverMotion", moverMotion())
      .set("motionScale", motionScale)
      .set("reach", 1)
      .image("carried", carried, ImageAccess::kWrite);
  dispatchBusy(carry, BlockCommand::kBusy);
  bindBusy(countParts.use())
      .texture("labels", labels.at(now))
      .texture("carried", carried)
      .storage("Blocks", parts);
  dispatchBusy(countParts, BlockCommand::kCount);
  findParts.use()
      .texture("moverMotion", moverMotion())
      .storage("Blocks", parts)
      .image("numbers", numbers, ImageAccess::kWrite);
  dispatchBusy(findParts, BlockCommand::kParts);
  bindBusy(number.use())
      .texture("labels", labels.at(now))
      .texture("picture", pictures.at(now))
      .texture("carried", carried)
      .texture("numbers", numbers)
      .set("reach", 1)
      .image("shares", shares.at(now), ImageAccess::kWrite);
  dispatchBusy(number, BlockCommand::kBusy);
}

MotionLayers::MotionLayers(const gpu::ShaderLibrary& library, hal::FrameSize full)
    : state_(std::make_unique<State>(library, full)) {}

MotionLayers::~MotionLayers() = default;

void MotionLayers::update(const scene::ArFrame& frame, const MotionField& motion,
                          const MotionLayersOptions& options) {
  State& s = *state_;
  assert(frame.full() == s.full);
  // A picture of another quality level differs everywhere.
  if (motion.isCut()) s.hasPast = s.hasActivity = false;
  if (s.frameSize != frame.size()) s.hasPast = false;
  s.frameSize = frame.size();
  if (!s.hasPast) s.forgetFront();
  const hal::Duration passed =
      s.hasPast ? timeStep(s.lastTime, frame.captureTime) : hal::Duration(0);
  const auto step = static_cast<float>(hal::toSeconds(passed));
  const float motionScale = s.lastStep > 0.0F ? step / s.lastStep : 1.0F;
  s.sinceFirst = s.hasPast ? s.sinceFirst + passed : hal::Duration(0);
  const std::size_t before = s.now;
  s.now = 1 - s.now;
  s.turn = (s.turn + 1) % kTurns;
  const bool isAtRest =
      motion.isStanding() && !frame.hasObjects && !knowsSurfaces(frame, motion, s.last);
  s.beginToCompare(isAtRest ? s.compareAtRest : s.compare, frame, motion, step)
      .image("pictureNow", s.pictures.at(s.now), ImageAccess::kWrite)
      .dispatch(s.cells(), kStored);
  s.bindBusy(s.markNear.use())
      .texture("moverMotion", s.moverMotion())
      .dispatch(s.blocks(), kStored);
  s.bindBusy(s.listNear.use()).dispatch({1, 1}, kListed);
  s.beginToCompare(s.compareNear, frame, motion, step)
      .texture("moverMotion", s.moverMotion())
      .texture("moverShares", s.shares.at(before))
      .set("motionScale", motionScale);
  s.dispatchBusy(s.compareNear, BlockCommand::kNear);
  s.inPlace.follow(frame, motion, s.candidates, s.activities.at(before), s.busyBlocks(),
                   {.stands = s.hasPast && motion.isStanding(), .hasStood = hasStood()}, step);
  s.bindBusy(s.markBusy.use()).storage("Blocks", s.parts).dispatch(s.blocks(), kStored);
  s.bindBusy(s.listBusy.use()).dispatch({1, 1}, kListed);
  s.findGround.use()
      .storage("Tally", s.tally)
      .set("turn", s.turn)
      .texture("candidates", s.candidates)
      .texture("evidence", s.evidence)
      .texture("picture", s.pictures.at(s.now))
      .texture("backgroundActivity", s.activities.at(before))
      .image("ground", s.ground, ImageAccess::kWrite);
  s.dispatchBusy(s.findGround, BlockCommand::kGround);
  gpu::Program& settle = isAtRest ? s.settleAtRest : s.settle;
  s.begin(settle, frame, motion, step);
  s.bindBusy(settle)
      .set("hasPast", s.hasPast ? 1 : 0)
      .texture("evidence", s.evidence)
      .texture("picture", s.pictures.at(s.now))
      .texture("background", s.backgrounds.at(before))
      .texture("backgroundActivity", s.activities.at(before))
      .set("freshSeconds", kFreshSeconds)
      .set("hasActivity", s.hasActivity ? 1 : 0)
      .set("noise", cellNoise(motion))
      .image("labels", s.labels.at(s.now), ImageAccess::kWrite)
      .image("backgroundNow", s.backgrounds.at(s.now), ImageAccess::kWrite)
      .image("activityNow", s.activities.at(s.now), ImageAccess::kWrite)
      .dispatch(s.cells(), kStored);
  s.inPlace.find(frame, s.candidates, s.busyBlocks(), s.carried);
  s.begin(s.join, frame, motion, step);
  s.bindBusy(s.join)
      .texture("ground", s.ground)
      .texture("candidates", s.candidates)
      .texture("evidence", s.evidence)
      .texture("picture", s.pictures.at(s.now))
      .texture("background", s.backgrounds.at(before))
      .texture("backgroundActivity", s.activities.at(before))
      .texture("inPlace", s.carried)
      .texture("front", s.hasFront ? s.front.front() : s.nothing)
      .set("hasFront", s.hasFront ? 1 : 0)
      .set("isDoubted", s.sinceFirst < kDoubted ? 1 : 0)
      .set("frontRestSeconds", static_cast<float>(hal::toSeconds(options.restBeforeModels)))
      .set("restSeconds", static_cast<float>(hal::toSeconds(options.rest)))
      .set("freshSeconds", kFreshSeconds)
      .set("reach", 1)
      .set("noise", cellNoise(motion))
      .image("labels", s.labels.at(s.now), ImageAccess::kWrite)
      .image("backgroundNow", s.backgrounds.at(s.now), ImageAccess::kWrite)
      .image("activityNow", s.activities.at(s.now), ImageAccess::kWrite);
  s.dispatchBusy(s.join, BlockCommand::kBusy);
  s.tellApart(frame, motion, motionScale);
  s.motionOfMovers.update({.frame = &frame,
                           .field = &motion,
                           .last = s.last,
                           .hasPast = s.hasPast,
                           .shares = &s.shares.at(s.now),
                           .lastShares = &s.shares.at(before),
                           .picture = &s.pictures.at(s.now),
                           .lastPicture = &s.pictures.at(before),
                           .blocks = s.busyBlocks(),
                           .turn = s.turn,
                           .stepSeconds = step,
                           .motionScale = motionScale},
                          s.binding);
  if (frame.hasObjects) {
    s.front.update(frame, s.labels.at(s.now), s.shares.at(s.now), s.busyBlocks(),
                   s.hasPast && motion.isStanding(), step);
    s.hasFront = true;
  } else {
    s.forgetFront();
  }
  s.last = frame.sequence;
  s.lastTime = frame.captureTime;
  s.lastStep = step;
  s.isStanding = s.hasPast && motion.isStanding();
  if (!s.hasPast) s.sinceStanding = kStandingHold;
  s.sinceStanding = s.isStanding ? hal::Duration(0) : s.sinceStanding + passed;
  s.hasPast = true;
  s.hasActivity = true;
}

const gpu::Texture& MotionLayers::labels() const {
  return state_->hasFront ? state_->front.seenLabels() : state_->labels.at(state_->now);
}

const gpu::Texture& MotionLayers::shares() const {
  return state_->hasFront ? state_->front.seenShares() : state_->shares.at(state_->now);
}

BusyBlocks MotionLayers::busyBlocks() const {
  return state_->busyBlocks();
}

std::optional<scene::ModelCover> MotionLayers::cover() const {
  if (!state_->hasFront) return std::nullopt;
  return state_->front.cover();
}

const gpu::Texture& MotionLayers::background() const {
  return state_->backgrounds.at(state_->now);
}

const gpu::Texture& MotionLayers::activity() const {
  return state_->activities.at(state_->now);
}

const gpu::Texture& MotionLayers::moverMotion() const {
  return state_->moverMotion();
}

const gpu::Texture& MotionLayers::displacements() const {
  return state_->inPlace.displacements();
}

bool MotionLayers::isStanding() const {
  return state_->isStanding;
}

bool MotionLayers::hasStood() const {
  return state_->hasPast && state_->sinceStanding < kStandingHold;
}

hal::Image MotionLayers::readMovers() const {
  constexpr std::size_t kChannels = 4;
  const hal::FrameSize size = state_->size;
  std::vector<float> values(kChannels * static_cast<std::size_t>(size.pixels()));
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);  // written as an image
  const gpu::RenderTarget target({&labels()});
  target.beginKeeping();
  glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_FLOAT, values.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  hal::Image movers({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
  const std::span<std::uint8_t> levels = movers.plane(0);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i] = values[kChannels * i] > 0.5F ? 255 : 0;
  }
  return movers;
}

void MotionLayers::reset() {
  state_->hasPast = state_->hasActivity = false;
}

}  // namespace pleinair::marks
