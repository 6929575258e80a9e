#include "sim/scene/picture_messages.h"

#include <sys/socket.h>

#include <cerrno>

namespace dendro::scene {
namespace {

bool send_all(int socket, Span span) {
  const char* at = static_cast<const char*>(span.data);
  while (span.size > 0) {
    // Without a signal: the loss of the other end is an error message, not the end of this process.
    const ssize_t n = ::send(socket, at, span.size, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    span.size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = ::recv(socket, at, size, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

bool send_message(int socket, const nlohmann::json& head, const std::vector<Span>& spans) {
  // CBOR, as the name of a file may be any bytes.
  const std::vector<std::uint8_t> text = nlohmann::json::to_cbor(head);
  std::uint64_t sizes[] = {text.size(), 0};
  for (const Span& span : spans) sizes[1] += span.size;
  if (!send_all(socket, {sizes, sizeof sizes}) || !send_all(socket, {text.data(), text.size()})) return false;
  for (const Span& span : spans)
    if (!send_all(socket, span)) return false;
  return true;
}

bool receive_message(int socket, PictureMessage& message) {
  std::uint64_t sizes[2];
  if (!receive_all(socket, sizes, sizeof sizes)) return false;
  std::vector<std::uint8_t> text(sizes[0]);
  message.bytes.resize(sizes[1]);
  if (!receive_all(socket, text.data(), text.size()) || !receive_all(socket, message.bytes.data(), sizes[1])) return false;
  message.head = nlohmann::json::from_cbor(text);
  return true;
}

}  // namespace dendro::scene
