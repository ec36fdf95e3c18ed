#include "hal/error.h"

#include <cerrno>
#include <system_error>
#include <utility>

namespace pleinair::hal {
namespace {

ErrorKind kindOfErrno(int value) {
  switch (value) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return ErrorKind::kNotFound;
    case EACCES:
    case EPERM:
    case EROFS:
      return ErrorKind::kPermissionDenied;
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return ErrorKind::kNoSpace;
    case EBUSY:
      return ErrorKind::kBusy;
    case ETIMEDOUT:
      return ErrorKind::kTimeout;
    case EINVAL:
    case ENOTDIR:
    case EISDIR:
    case ENAMETOOLONG:
    case ELOOP:
      return ErrorKind::kInvalidArgument;
    default:
      return ErrorKind::kIo;
  }
}

}  // namespace

std::string Error::message() const {
  std::string text = subject.empty() ? problem : subject + ": " + problem;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

Error errnoError(std::string subject, std::string problem, int errnoValue, std::string remedy) {
  return Error{.kind = kindOfErrno(errnoValue),
               .subject = std::move(subject),
               .problem = std::move(problem) + ": " + std::generic_category().message(errnoValue),
               .remedy = std::move(remedy),
               .domain = ErrorDomain::kErrno,
               .code = errnoValue};
}

Failure::Failure(Error error) : std::runtime_error(error.message()), error_(std::move(error)) {}

}  // namespace pleinair::hal
