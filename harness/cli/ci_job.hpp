// The job of a CI system that runs the cases on a device of a bench file.
#pragma once

#include <string>

namespace fieldproof::cli {

struct CiJob {
  std::string file;  // ".gitlab-ci.yml"
  std::string text;
};

/// "github" or "gitlab". `arguments` follow `fieldproof run`. `own_runner`: the device hangs on a
/// computer of its own.
CiJob ci_job(const std::string& system, const std::string& arguments, bool own_runner);

}  // namespace fieldproof::cli
