#include "reports/results/file_error.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <system_error>

namespace fieldproof::results {
namespace {

const char* advice(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR: return "; check the path, and that its folder exists";
    case EACCES:
    case EPERM:
    case EROFS: return "; choose a place that this user may use";
    case ENOSPC:
    case EDQUOT: return "; free some space";
    case EISDIR: return "; name a file in it";
    case EWOULDBLOCK: return ": another run writes it; wait for that run, or choose another --out";
    default: return "";
  }
}

}  // namespace

Error file_error(std::string_view verb, const std::string& path, int error) {
  std::string cause = error == EWOULDBLOCK ? "" : std::generic_category().message(error);
  if (!cause.empty())
    cause = fmt::format(": {}{}", static_cast<char>(std::tolower(cause[0])), cause.substr(1));
  return fail(fmt::format("cannot {} {}{}{}", verb, path, cause, advice(error)));
}

}  // namespace fieldproof::results
