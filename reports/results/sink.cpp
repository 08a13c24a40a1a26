#include "reports/results/sink.hpp"

#include "reports/results/result_json.hpp"

namespace fieldproof::results {

const std::string& Delivery::json() const {
  if (json_.empty()) append_json(json_, result_);
  return json_;
}

Status Sinks::each(const auto& call) {
  std::erase_if(sinks_, [&](const std::unique_ptr<Sink>& sink) {
    const Status done = call(*sink);
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
Status Sinks::add(const SoakSample& sample) {
  return each([&](Sink& sink) { return sink.add(sample); });
}
Status Sinks::add(const SoakSummary& soak) {
  return each([&](Sink& sink) { return sink.add(soak); });
}
Status Sinks::end(const RunLog& log) {
  return each([&](Sink& sink) { return sink.end(log); });
}

}  // namespace fieldproof::results
