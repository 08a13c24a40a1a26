// RFC 2217 servers for tests: a real ser2net, and one that does what it is told.
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "harness/endpoints/serial_ports/rfc2217_telnet.hpp"
#include "harness/system/child_process.hpp"

namespace fieldproof::endpoints::test {

/// A listening socket of loopback; its port in `port`.
inline os::UniqueFd listen_anywhere(int& port) {
  os::UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(fd.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::listen(fd.get(), 4), 0);
  EXPECT_EQ(::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  port = ntohs(address.sin_port);
  return fd;
}

/// How a ser2net serves its port.
struct Ser2netOptions {
  std::string accepter = "telnet(rfc2217)";
  int port = 0;  // one that is free
  std::string connector = "serialdev";
  std::vector<std::string> options{"chardelay: false"};

  /// As labgrid's exporter writes it.
  static Ser2netOptions of_labgrid() {
    return {
        "telnet(rfc2217,mode=server)", 0, "serialdev(nouucplock=true)", {"max-connections: 10"}};
  }
};

/// ser2net in front of one terminal. It listens when the constructor is over, and has ended when
/// the object is gone.
class Ser2net {
 public:
  explicit Ser2net(const std::string& tty, const Ser2netOptions& served = {}) : port_(served.port) {
    if (port_ == 0) listen_anywhere(port_);
    std::string pattern = (std::filesystem::temp_directory_path() / "ser2net_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    std::ofstream file(folder_ / "ser2net.yaml");
    file << "%YAML 1.1\n---\nconnection: &bench\n  accepter: " << served.accepter
         << ",tcp,127.0.0.1," << port_ << "\n  connector: " << served.connector << ',' << tty
         << ",9600n81,local\n  options:\n";
    for (const std::string& option : served.options) file << "    " << option << '\n';
    file.close();
    // It writes its pid file when it listens: into this pipe.
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    const os::UniqueFd ready(ends[0]);
    os::UniqueFd pid_file(ends[1]);
    os::ChildOptions options;
    options.arguments = {
        "/usr/sbin/ser2net",      "-n", "-c",
        folder_ / "ser2net.yaml", "-P", "/dev/fd/" + std::to_string(pid_file.get())};
    options.keep = {pid_file.get()};
    Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
    EXPECT_TRUE(child) << child.error().message;
    if (!child) return;
    child_ = std::move(*child);
    pid_file.reset();
    pollfd listens{ready.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&listens, 1, 10'000), 1) << "ser2net does not start: " << child_->how();
    EXPECT_TRUE(listens.revents & POLLIN) << child_->how();
  }
  ~Ser2net() {
    kill();
    std::filesystem::remove_all(folder_);
  }
  Ser2net(const Ser2net&) = delete;
  Ser2net& operator=(const Ser2net&) = delete;

  void kill() { child_.reset(); }
  int port() const { return port_; }
  std::string where() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  int port_;
  std::filesystem::path folder_;
  std::unique_ptr<os::ChildProcess> child_;
};

/// How a FakeServer differs from a good one.
struct FakeServerOptions {
  std::string greeting{};  // sent before anything else
  bool speaks_telnet = true;
  bool has_com_port = true;
  bool has_binary = true;
  std::vector<Byte> unconfirmed{};  // commands that it ignores
  unsigned only_baud = 0;           // it confirms any speed with this one
};

/// Serves one connection after the other in a thread of its own. Data is answered with the same
/// data.
class FakeServer {
 public:
  explicit FakeServer(FakeServerOptions options = {})
      : options_(std::move(options)),
        listener_(listen_anywhere(port_)),
        stop_(::eventfd(0, EFD_CLOEXEC)),
        thread_([this] { serve(); }) {}
  ~FakeServer() {
    ::eventfd_write(stop_.get(), 1);
    thread_.join();
  }
  std::string where() const { return "127.0.0.1:" + std::to_string(port_); }
  /// From now on nothing is answered, and the connection stays: a host that died.
  void play_dead() { dead_ = true; }
  /// Notifies the client of a line state at its next data, before the echo.
  void notify_next(Byte line_state) { line_state_ = line_state; }
  /// "data 41", "5 0B" (command and value in hex), in the order they came.
  std::vector<std::string> heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  void serve() {
    os::UniqueFd client;
    telnet::Decoder decoder;
    for (;;) {
      pollfd fds[3]{
          {stop_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}, {client.get(), POLLIN, 0}};
      ::poll(fds, 3, -1);
      if (fds[0].revents != 0) return;
      if (fds[1].revents != 0) {
        client.reset(::accept(listener_.get(), nullptr, nullptr));
        decoder = {};
        send(client, to_bytes(options_.greeting));
      }
      if (!client || fds[2].revents == 0) continue;
      Byte buffer[4096];
      const ssize_t size = ::read(client.get(), buffer, sizeof buffer);
      if (size <= 0) {
        client.reset();
        continue;
      }
      if (!options_.speaks_telnet || dead_) continue;
      for (const telnet::Message& message :
           decoder.decode({buffer, static_cast<std::size_t>(size)}))
        send(client, answer(message));
    }
  }

  static void send(const os::UniqueFd& client, const Bytes& bytes) {
    // The client may have left already.
    if (!bytes.empty())
      static_cast<void>(::send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }

  Bytes answer(const telnet::Message& message) {
    if (const auto* asked = std::get_if<telnet::Negotiation>(&message)) return agree(*asked);
    if (const Bytes* data = std::get_if<Bytes>(&message)) {
      note("data " + to_hex(*data));
      Bytes reply = telnet::escaped(*data);
      if (const Byte state = line_state_.exchange(0)) {
        const Bytes notification =
            telnet::command(telnet::answer + telnet::notify_line_state, {{state}});
        reply.insert(reply.begin(), notification.begin(), notification.end());
      }
      return reply;
    }
    const auto& [command, value] = std::get<telnet::Notification>(message);
    note(std::to_string(command) + ' ' + to_hex(value));
    if (std::ranges::find(options_.unconfirmed, command) != options_.unconfirmed.end()) return {};
    const unsigned baud = options_.only_baud;
    const Bytes taken = command == telnet::set_baud_rate && baud != 0
                            ? Bytes{0, 0, static_cast<Byte>(baud >> 8), static_cast<Byte>(baud)}
                            : value;
    return telnet::command(static_cast<Byte>(command + telnet::answer), taken);
  }

  Bytes agree(const telnet::Negotiation& asked) const {
    const bool has = asked.option == telnet::com_port ? options_.has_com_port : options_.has_binary;
    if (asked.verb == telnet::will)
      return telnet::negotiation(has ? telnet::do_it : telnet::dont, asked.option);
    if (asked.verb == telnet::do_it)
      return telnet::negotiation(has ? telnet::will : telnet::wont, asked.option);
    return {};
  }

  void note(std::string text) {
    const std::lock_guard lock(mutex_);
    heard_.push_back(std::move(text));
  }

  FakeServerOptions options_;
  int port_ = 0;
  os::UniqueFd listener_;
  os::UniqueFd stop_;
  std::atomic<bool> dead_{false};
  std::atomic<Byte> line_state_{0};
  std::mutex mutex_;
  std::vector<std::string> heard_;
  std::thread thread_;
};

}  // namespace fieldproof::endpoints::test
