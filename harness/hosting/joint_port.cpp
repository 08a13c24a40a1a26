#include "harness/hosting/host_port.hpp"

namespace fieldproof::hosting {

namespace {

/// Links are of the network, what is on no link is of the line.
class JointPort final : public HostPort {
 public:
  JointPort(std::unique_ptr<HostPort> network, std::unique_ptr<HostPort> line)
      : network_(std::move(network)), line_(std::move(line)) {}

  std::string describe() const override { return network_->describe() + ", " + line_->describe(); }
  Duration own_silence() const override { return line_->own_silence(); }
  void add_to(std::vector<pollfd>& fds) const override {
    const std::size_t before = fds.size();
    network_->add_to(fds);
    of_network_ = fds.size() - before;
    line_->add_to(fds);
  }
  void heard(std::span<const pollfd> answers) override {
    network_->heard(answers.first(of_network_));
    line_->heard(answers.subspan(of_network_));
  }
  /// Each in turn: one that floods does not silence the other.
  Result<std::optional<Burst>> read() override {
    line_first_ = !line_first_;
    Result<std::optional<Burst>> burst = (line_first_ ? line_ : network_)->read();
    if (!burst || *burst) return burst;
    return (line_first_ ? network_ : line_)->read();
  }
  void write(const Burst& burst) override { of(burst.link).write(burst); }
  bool stands(LinkId link) const override { return of(link).stands(link); }
  void flush() override {
    network_->flush();
    line_->flush();
  }

 private:
  HostPort& of(LinkId link) const { return link == line_link ? *line_ : *network_; }

  std::unique_ptr<HostPort> network_, line_;
  mutable std::size_t of_network_ = 0;  // descriptors of the last add_to
  bool line_first_ = false;
};

}  // namespace

std::unique_ptr<HostPort> join_ports(std::unique_ptr<HostPort> network,
                                     std::unique_ptr<HostPort> line) {
  return std::make_unique<JointPort>(std::move(network), std::move(line));
}

}  // namespace fieldproof::hosting
