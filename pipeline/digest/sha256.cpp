#include "pipeline/digest/sha256.h"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include <nettle/sha2.h>

namespace pleinair::digest {

static_assert(std::tuple_size_v<Sha256> == SHA256_DIGEST_SIZE);

struct Sha256Stream::State {
  sha256_ctx context;
};

Sha256Stream::Sha256Stream() : state_(std::make_unique<State>()) {
  sha256_init(&state_->context);
}

Sha256Stream::~Sha256Stream() = default;

void Sha256Stream::add(std::span<const std::uint8_t> bytes) {
  sha256_update(&state_->context, bytes.size(), bytes.data());
}

void Sha256Stream::add(std::string_view text) {
  add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Sha256 Sha256Stream::finish() {
  Sha256 digest{};
  sha256_digest(&state_->context, digest.size(), digest.data());
  return digest;
}

Sha256 sha256(std::string_view bytes) {
  Sha256Stream stream;
  stream.add(bytes);
  return stream.finish();
}

std::string hexOf(const Sha256& digest) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * digest.size());
  for (const std::uint8_t byte : digest) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

hal::Result<std::string> hexOfFile(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (failure) {
    return tl::unexpected(hal::errnoError(path.string(), "cannot open", failure.value()));
  }
  if (!std::filesystem::is_regular_file(status)) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                     .subject = path.string(),
                                     .problem = "is not a regular file"});
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(hal::errnoError(path.string(), "cannot open", errno));
  Sha256Stream stream;
  std::vector<char> piece(std::size_t{1} << 16U);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    stream.add(std::string_view(piece.data(), count));
  }
  if (file.bad()) return tl::unexpected(hal::errnoError(path.string(), "cannot read", EIO));
  return hexOf(stream.finish());
}

}  // namespace pleinair::digest
