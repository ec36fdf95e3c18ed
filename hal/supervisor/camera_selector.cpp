#include "hal/supervisor/camera_selector.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace pleinair::hal {
namespace {

constexpr std::string_view kAuto = "auto";
constexpr std::string_view kSerial = "serial";
/// How often a search begins again because devices have come or gone meanwhile.
constexpr int kMostRestarts = 3;

/// "BACKEND:NAME" or "BACKEND".
struct Choice {
  std::string_view backend;
  std::string_view name;
};

Choice choiceOf(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return {.backend = text, .name = {}};
  return {.backend = text.substr(0, colon), .name = text.substr(colon + 1)};
}

bool isSameCamera(const CameraIdentity& a, const CameraIdentity& b) {
  return a.backend == b.backend && a.id == b.id;
}

/// Whether both are one device at one place of a bus.
bool isSameDevice(const CameraDescription& a, const CameraDescription& b) {
  return !a.path.empty() && a.path == b.path && a.serial == b.serial;
}

std::string joined(const std::vector<std::string>& texts, std::string_view between) {
  std::string all;
  for (const std::string& text : texts) {
    if (!all.empty()) all += between;
    all += text;
  }
  return all;
}

/// "1) …; 2) …", as one error of the kind that all agree on.
Error noneWorks(const std::string& choice, const std::vector<Error>& reasons) {
  Error error{.kind = ErrorKind::kNotFound,
              .subject = choice,
              .problem = "there is no camera",
              .remedy = "plug one in, or choose another camera.source"};
  if (reasons.empty()) return error;
  std::vector<std::string> texts;
  texts.reserve(reasons.size());
  for (const Error& reason : reasons) {
    texts.push_back(std::to_string(texts.size() + 1) + ") " + reason.message());
  }
  error.problem = "no camera works: " + joined(texts, "; ");
  const auto isOfTheFirstKind = [&](const Error& each) { return each.kind == reasons[0].kind; };
  if (std::ranges::all_of(reasons, isOfTheFirstKind)) error.kind = reasons[0].kind;
  return error;
}

}  // namespace

CameraSelector::CameraSelector(std::vector<SelectableBackend> backends, std::string choice,
                               Clock& clock, CameraWrapper wrapper)
    : backends_(std::move(backends)),
      choice_(std::move(choice)),
      clock_(clock),
      wrapper_(std::move(wrapper)) {
  assert(!backends_.empty());
}

Result<void> CameraSelector::check() const {
  const auto [backend, name] = choiceOf(choice_);
  const bool isSerial = backend == kSerial && !name.empty();
  if (choice_ == kAuto || isSerial || backendNamed(backend)) return {};
  std::vector<std::string> choices{std::string(kAuto), std::string(kSerial) + ":NUMBER"};
  for (const SelectableBackend& each : backends_) {
    choices.emplace_back(each.backend->name());
    choices.push_back(std::string(each.backend->name()) + ":ID");
  }
  return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                              .subject = choice_.empty() ? "\"\"" : choice_,
                              .problem = "is no camera",
                              .remedy = "choose one of: " + joined(choices, ", ")});
}

Result<OpenedCamera> CameraSelector::open(const StreamRequest& request) {
  if (const Result<void> sound = check(); !sound) return tl::unexpected(sound.error());
  const auto [backendName, name] = choiceOf(choice_);
  if (choice_ == kAuto) return openFirst(devices(), request);
  if (const SelectableBackend* backend = backendNamed(backendName)) {
    return name.empty() ? openFirst({backend}, request) : openNamed(*backend, name, request);
  }
  return openSerial(name, request);
}

CameraSelector::Candidates CameraSelector::listed(
    const std::vector<const SelectableBackend*>& backends) const {
  Candidates candidates;
  for (const SelectableBackend* backend : backends) {
    Result<std::vector<CameraDescription>> list = backend->backend->list();
    if (!list) {
      candidates.problems.push_back(std::move(list.error()));
      continue;
    }
    for (CameraDescription& description : *list) {
      candidates.found.push_back({.backend = backend, .description = std::move(description)});
    }
  }
  return candidates;
}

std::vector<const SelectableBackend*> CameraSelector::devices() const {
  std::vector<const SelectableBackend*> devices;
  for (const SelectableBackend& each : backends_) {
    if (each.isDevice) devices.push_back(&each);
  }
  return devices;
}

const SelectableBackend* CameraSelector::backendNamed(std::string_view name) const {
  const auto found = std::ranges::find_if(
      backends_, [&](const SelectableBackend& each) { return each.backend->name() == name; });
  return found == backends_.end() ? nullptr : &*found;
}

std::optional<OpenedCamera> CameraSelector::tried(const Candidate& candidate,
                                                  const StreamRequest& request,
                                                  std::vector<Error>& reasons) {
  if (candidate.description.problem) {
    reasons.push_back(*candidate.description.problem);
    return std::nullopt;
  }
  Result<OpenedCamera> opened = start(candidate, request);
  if (opened) return std::move(*opened);
  reasons.push_back(std::move(opened.error()));
  return std::nullopt;
}

std::optional<OpenedCamera> CameraSelector::openOf(const SelectableBackend& backend,
                                                   const StreamRequest& request,
                                                   std::vector<Candidate>& lastOnes,
                                                   std::vector<Error>& reasons) {
  Candidates candidates = listed({&backend});
  std::ranges::move(candidates.problems, std::back_inserter(reasons));
  for (Candidate& each : candidates.found) {
    if (rankOf(each) >= 0) {
      lastOnes.push_back(std::move(each));
    } else if (auto opened = tried(each, request, reasons)) {
      return opened;
    }
  }
  return std::nullopt;
}

Result<OpenedCamera> CameraSelector::openFirst(
    const std::vector<const SelectableBackend*>& backends, const StreamRequest& request) {
  std::vector<Error> reasons;
  std::vector<Candidate> lastOnes;
  int restarts = 0;
  haveDevicesChanged_ = false;
  // A back end is asked for its cameras only when those before it have failed: asking a network
  // takes a second.
  for (std::size_t i = 0; i < backends.size();) {
    if (auto opened = openOf(*backends[i], request, lastOnes, reasons)) return *std::move(opened);
    if (stopping_.stop_requested()) break;
    const bool isLast = ++i == backends.size();
    if (isLast || !haveDevicesChanged_.exchange(false) || restarts == kMostRestarts) continue;
    ++restarts;
    reasons.clear();
    lastOnes.clear();
    i = 0;
  }
  std::ranges::stable_sort(lastOnes, {}, [&](const Candidate& each) { return rankOf(each); });
  for (const Candidate& each : lastOnes) {
    if (auto opened = tried(each, request, reasons)) return *std::move(opened);
  }
  return tl::unexpected(noneWorks(choice_, reasons));
}

Result<OpenedCamera> CameraSelector::openSerial(std::string_view serial,
                                                const StreamRequest& request) {
  Candidates candidates = listed(devices());
  std::vector<std::string> serials;
  for (const Candidate& each : candidates.found) {
    if (each.description.serial == serial) return start(each, request);
    if (!each.description.serial.empty()) serials.push_back(each.description.serial);
  }
  std::string problem = "no camera with that serial number is there";
  for (const Error& each : candidates.problems) problem += "; " + each.message();
  return tl::unexpected(Error{.kind = ErrorKind::kNotFound,
                              .subject = choice_,
                              .problem = std::move(problem),
                              .remedy = serials.empty() ? "none that is there has one"
                                                        : "there are: " + joined(serials, ", ")});
}

Result<OpenedCamera> CameraSelector::openNamed(const SelectableBackend& backend,
                                               std::string_view name,
                                               const StreamRequest& request) {
  const std::vector<Candidate> found = listed({&backend}).found;
  for (const Candidate& each : found) {
    if (each.description.node != name) continue;
    Result<OpenedCamera> opened = start(each, request);
    if (opened) {
      openedByNode_ = each.description;
      openedByNode_->kept.reset();
    }
    return opened;
  }
  // A driver that was reset may give its camera another node.
  for (const Candidate& each : found) {
    if (openedByNode_ && isSameDevice(each.description, *openedByNode_)) {
      return start(each, request);
    }
  }
  // A name that is not listed may be another one that the back end knows; if not, it says what
  // there is.
  const CameraIdentity identity{
      .backend = std::string(backend.backend->name()), .id = std::string(name), .description = {}};
  return start({.backend = &backend, .description = {.identity = identity}}, request);
}

Result<OpenedCamera> CameraSelector::start(const Candidate& candidate,
                                           const StreamRequest& request) {
  if (stopping_.stop_requested()) {
    return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                .subject = choice_,
                                .problem = "is not opened: the program stops"});
  }
  const SelectableBackend& from = *candidate.backend;
  const CameraFactory make = [backend = from.backend, id = candidate.description.identity.id](
                                 Clock& clock) { return backend->make(id, clock); };
  OpenedCamera opened{
      .camera = from.isDevice && wrapper_ ? wrapper_(make, stopping_.get_token()) : make(clock_),
      .format = {},
      .isDevice = from.isDevice};
  Result<StreamFormat> format = opened.camera->start(request);
  if (!format) return tl::unexpected(std::move(format.error()));
  opened.format = *format;
  return opened;
}

void CameraSelector::putLast(const CameraIdentity& camera) {
  wasOfUse(camera);
  last_.push_back(camera);
}

void CameraSelector::wasOfUse(const CameraIdentity& camera) {
  std::erase_if(last_, [&](const CameraIdentity& each) { return isSameCamera(each, camera); });
}

std::ptrdiff_t CameraSelector::rankOf(const Candidate& candidate) const {
  const auto found = std::ranges::find_if(last_, [&](const CameraIdentity& each) {
    return isSameCamera(each, candidate.description.identity);
  });
  return found == last_.end() ? -1 : std::distance(last_.begin(), found);
}

}  // namespace pleinair::hal
