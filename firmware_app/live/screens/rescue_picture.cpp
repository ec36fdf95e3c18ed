#include "firmware_app/live/screens/rescue_picture.h"

#include <utility>

namespace pleinair::app {
namespace {

/// Stands in for a camera's stream, which chooses a display's mode.
constexpr hal::OutputRequest kRequest{.size = {1280, 720},
                                      .framePeriod = std::chrono::milliseconds(40)};
const hal::StreamFormat kStream{
    .frame = {.pixelFormat = hal::PixelFormat::kRgb8, .size = kRequest.size, .encoding = {}},
    .framePeriod = kRequest.framePeriod,
    .frameCount = {}};

std::unique_ptr<runtime::OutputStage> openScreen(const std::string& target,
                                                 const OutputOpener& open, hal::Clock& clock,
                                                 runtime::FrameLedger& ledger) {
  runtime::OutputStageOptions options = outputRules(target, open, {}, kStream);
  options.request = kRequest;
  auto opened = open(target);
  auto format = opened ? (*opened)->start(kRequest)
                       : hal::Result<hal::OutputFormat>(tl::unexpected(opened.error()));
  if (format) {
    return std::make_unique<runtime::OutputStage>(*std::move(opened), *format, std::move(options),
                                                  clock, ledger);
  }
  if (!options.reopen) throw hal::Failure(std::move(format.error()));
  options.absence = std::move(format.error());
  const hal::OutputFormat standIn{
      .frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = kRequest.size, .encoding = {}},
      .refresh = std::nullopt};
  return std::make_unique<runtime::OutputStage>(nullptr, standIn, std::move(options), clock,
                                                ledger);
}

}  // namespace

RescuePicture::RescuePicture(const std::vector<std::string>& targets, const OutputOpener& open,
                             present::WaitingText text, std::optional<hal::Image> painting,
                             hal::Duration renewal, hal::Clock& clock)
    : text_(std::move(text)), painting_(std::move(painting)), renewal_(renewal), clock_(clock) {
  for (const std::string& target : targets) {
    screens_.push_back({.stage = openScreen(target, open, clock, ledger_), .picture = {}});
  }
}

void RescuePicture::step() {
  const hal::TimePoint now = clock_.now();
  for (Screen& each : screens_) {
    const runtime::OutputStage::Status status = each.stage->status();
    const bool isStale = renewal_ > hal::Duration{0} && now - each.handedOver >= renewal_;
    if (!status.isFailed && status.starts != each.drawnFor) {
      draw(each, status.starts);
    } else if (!status.isFailed && isStale && each.picture) {
      each.handedOver = now;
      each.stage->showWaiting(each.picture);
    }
    each.stage->step();
  }
}

void RescuePicture::draw(Screen& screen, std::uint64_t start) const {
  const hal::OutputFormat format = screen.stage->format();
  hal::FrameSize upright = format.frame.size;
  if (format.quarterTurns % 2 != 0) std::swap(upright.width, upright.height);
  const hal::ImageView painting = painting_ ? painting_->view() : hal::ImageView();
  screen.picture = std::make_shared<const hal::Image>(
      present::turned(present::waitingPicture(upright, painting, text_), format.quarterTurns));
  screen.drawnFor = start;
  screen.handedOver = clock_.now();
  screen.stage->showWaiting(screen.picture);
}

std::vector<OutputProgress> RescuePicture::progress() const {
  std::vector<OutputProgress> progress;
  for (const Screen& each : screens_) progress.push_back(progressOf(each.stage->status(), true));
  return progress;
}

std::string RescuePicture::problem() const {
  for (const Screen& each : screens_) {
    const runtime::OutputStage::Status status = each.stage->status();
    if (status.isFailed && status.failure) return status.failure->message();
    if (status.suspension) return status.suspension->reason;
  }
  return {};
}

}  // namespace pleinair::app
