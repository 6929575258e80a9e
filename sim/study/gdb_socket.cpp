#include "sim/study/gdb_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "sim/base/error.h"

namespace dendro::study {
namespace {

constexpr char kControlC = 3;
constexpr int kPatienceMs = 1000, kLookMs = 100;

[[noreturn]] void refuse(int port, int error) {
  throw UserError("--gdb", 0, "", fmt::format("port {} of 127.0.0.1: {}", port, std::strerror(error)));
}

}  // namespace

GdbSocket::GdbSocket(int port, std::function<std::optional<int>()> exit_code, std::function<void()> look)
    : exit_code_(std::move(exit_code)), look_(std::move(look)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (listener_ < 0) refuse(port, errno);
  const int yes = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, any, size) != 0 || listen(listener_, 1) != 0 || getsockname(listener_, any, &size) != 0) {
    const int error = errno;
    close(listener_);
    refuse(port, error);
  }
  port_ = ntohs(address.sin_port);
}

GdbSocket::~GdbSocket() {
  if (connection_ >= 0) close(connection_);
  if (listener_ >= 0) close(listener_);
}

/// Until there is something to read, or an error that reading will tell.
void GdbSocket::wait_for(int socket) const {
  pollfd event = {socket, POLLIN, 0};
  int ready = 0;
  do {
    if (look_) look_();
    ready = poll(&event, 1, kLookMs);
  } while (ready == 0 || (ready < 0 && errno == EINTR));
}

bool GdbSocket::read_more() {
  wait_for(connection_);
  char bytes[4096];
  ssize_t got = 0;
  do got = recv(connection_, bytes, sizeof bytes, 0);
  while (got < 0 && errno == EINTR);
  if (got <= 0) lost_ = true;
  if (got > 0) received_.append(bytes, static_cast<std::size_t>(got));
  return got > 0;
}

bool GdbSocket::send_all(const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t put = send(connection_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    at += static_cast<std::size_t>(put);
  }
  return true;
}

/// While the program runs GDB sends nothing but acknowledgements and the interrupt.
bool GdbSocket::interrupted() {
  if (look_) look_();
  pollfd event = {connection_, POLLIN, 0};
  if (!lost_ && poll(&event, 1, 0) == 1) read_more();
  const auto at = received_.find(kControlC);
  if (at == std::string::npos) return lost_;
  received_.erase(at, 1);
  return true;
}

bool GdbSocket::debug(Debuggee& program) {
  wait_for(listener_);
  do connection_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  while (connection_ < 0 && errno == EINTR);
  if (connection_ < 0) refuse(port_, errno);
  const int yes = 1;
  setsockopt(connection_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  GdbSession session(program, [this] { return interrupted(); }, exit_code_);
  while (!session.ending() && (!received_.empty() || read_more())) {
    // An interrupt stays for the run that the packet before it may start.
    const std::string bytes = received_.substr(0, received_.find(kControlC, received_[0] == kControlC));
    received_.erase(0, bytes.size());
    if (!send_all(session.receive(bytes))) break;
  }
  killed_ = session.ending() == GdbSession::Ending::kKilled;
  // What GDB still sends must not reset the connection before it has read the last answer.
  shutdown(connection_, SHUT_WR);
  pollfd event = {connection_, POLLIN, 0};
  while (!lost_ && poll(&event, 1, kPatienceMs) == 1) read_more();
  return !killed_;
}

}  // namespace dendro::study
