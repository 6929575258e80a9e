#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/parts/host/host_port.h"

namespace dendro::lib {

/// Micro-programs of one source for the image generation controller.
struct IgcPrograms {
  std::string name;                  ///< "firmware/half_space/pixel_planes/half_space.igc"
  std::string sha256;                ///< of the source with its registers' values
  std::vector<std::uint64_t> words;  ///< of the control store
  struct Entry {
    unsigned at = 0;  ///< first of its words
    std::string phase;
    bool uses_tree = false;
  };
  std::map<std::string, Entry> entries;
  std::map<std::string, unsigned> registers;  ///< numbers by name

  /// Appends programs; those of the same name replace the ones before.
  void append(const IgcPrograms& more);
};

/// A·x + B·y + C as the machine takes it.
struct Expression {
  float a = 0, b = 0, c = 0;
};

/// What the host of a Pixel-Planes machine writes (models/machines/pixel_planes/README.md).
class IgcDriver {
 public:
  IgcDriver(HostPort& host, const IgcPrograms& programs) : host_(host), programs_(programs) {}

  /// Reads the programs from a disk and writes the control store.
  void load();
  void show(unsigned colour_low, int width, int height);
  /// What is written from here on goes to renderer `number`.
  void select(std::size_t number);
  /// The picture's tile goes to the frame store when the commands before are done.
  void copy_tile(int column, int row);
  void set_register(const std::string& name, unsigned value);
  void run(const std::string& program, std::optional<std::uint64_t> constant = std::nullopt);
  void run(const std::string& program, const Expression& expression, unsigned fraction, unsigned guard,
           std::optional<std::uint64_t> constant = std::nullopt);
  void wait() { host_.wait_interrupt(); }

 private:
  void send(const std::string& program, const Expression* expression, unsigned fraction, unsigned guard,
            const std::optional<std::uint64_t>& constant);

  HostPort& host_;
  const IgcPrograms& programs_;
};

}  // namespace dendro::lib
