#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace dendro::scene {

/// What a process and its dendro-pictures say to each other over a socket: a head that names the work or its outcome, and pixels or a
/// file's bytes.
struct PictureMessage {
  nlohmann::json head;
  std::vector<std::uint8_t> bytes;
};

/// Bytes that are sent from where they are.
struct Span {
  const void* data;
  std::size_t size;
};

/// Sends a head and the spans as one message. False when nobody is at the other end.
bool send_message(int socket, const nlohmann::json& head, const std::vector<Span>& spans);

/// Waits for a message. False at the end of the connection.
bool receive_message(int socket, PictureMessage& message);

}  // namespace dendro::scene
