#include "reports/results/sink.hpp"

#include <fmt/format.h>

#include <exception>

#include "reports/results/result_json.hpp"

namespace fieldproof::results {

const std::string& Delivery::json() const {
  if (json_.empty()) append_json(json_, result_);
  return json_;
}

namespace {

/// A sink that throws is a sink that cannot go on: the others and the run do.
Status guarded(const auto& call, Sink& sink) {
  try {
    return call(sink);
  } catch (const std::exception& error) {
    return fail(fmt::format("internal error in a report: {}; please report it", error.what()));
  }
}

}  // namespace

Status Sinks::each(const auto& call) {
  std::erase_if(sinks_, [&](const std::unique_ptr<Sink>& sink) {
    const Status done = guarded(call, *sink);
    if (!done) troubles_.push_back(done.error().message);
    return !done;
  });
  return ok();
}

Status Sinks::begin(const RunInfo& run) {
  return each([&](Sink& sink) { return sink.begin(run); });
}
Status Sinks::add(const Delivery& one) {
  return each([&](Sink& sink) { return sink.add(one); });
}
Status Sinks::end(const RunLog& log) {
  RunLog told = log;
  return each([&](Sink& sink) {
    const Status done = guarded([&](Sink& one) { return one.end(told); }, sink);
    if (!done && told.end) told.end->add({3, "report", done.error().message});
    return done;
  });
}

}  // namespace fieldproof::results
