#include "firmware/lib/rds3000/rds_driver.h"

#include "sim/base/check.h"

namespace dendro::lib {
namespace {

// Word addresses [BRL-H, NYU-H]; devices other than image memory take function code 0.
constexpr std::uint32_t kControlStore = 0x800000;
constexpr std::uint32_t kScratchpad = 0x820000;
constexpr std::uint32_t kLookUpTable = 0x830000;
constexpr std::uint32_t kLuvoCrossbar = 0x830400;
constexpr std::uint32_t kProcessorStatus = 0x850000;
constexpr std::uint32_t kFrameBufferController = 0xC00000;
constexpr std::uint32_t kCrossbar = 0xC20000;
constexpr unsigned kWordFunction = 0;

constexpr std::uint32_t kViewportSize = 1;     // FBC register: size - 1, x in the low half
constexpr std::uint32_t kLuvoStraight = 0x24;  // channel k from byte k
constexpr std::uint32_t kPageWords = 4096;     // of the control store
constexpr unsigned kCrossbarLines = 34;

// Interface command bits [NYU-H].
constexpr std::uint32_t kRun = 01000;
constexpr std::uint32_t kReset = 02000;

/// Gaps up to this many words are sent as zeros: a second DMA would cost the host more.
constexpr std::uint32_t kLargestGap = 256;

}  // namespace

void RdsDriver::load_program(const ProgramImage& image, std::uint32_t page) {
  DENDRO_CHECK(image.words.size() <= kPageWords, "{} words", image.words.size());
  host_.program(image.name, page * kPageWords);
  Work work;
  work.program_loads = 1;
  host_.compute(work);
  std::vector<std::uint32_t> halves;
  for (const std::uint64_t word : image.words) {
    halves.push_back(static_cast<std::uint32_t>(word));
    halves.push_back(static_cast<std::uint32_t>(word >> 32));
  }
  if (!halves.empty())
    host_.dma_to(kControlStore + page * 2 * kPageWords, halves.data(), halves.size(), kWordFunction);
  write_initial_scratch(image);
}

void RdsDriver::write_initial_scratch(const ProgramImage& image) {
  auto next = image.initial_scratch.begin();
  while (next != image.initial_scratch.end()) {
    const std::uint32_t first = next->first;
    std::vector<std::uint32_t> run;
    for (; next != image.initial_scratch.end() && next->first <= first + run.size() + kLargestGap; ++next) {
      run.resize(next->first - first, 0);
      run.push_back(next->second);
    }
    write_scratch(first, run);
  }
}

void RdsDriver::write_scratch(std::uint32_t address, const std::vector<std::uint32_t>& words) {
  if (!words.empty()) host_.dma_to(kScratchpad + address, words.data(), words.size(), kWordFunction);
}

std::vector<std::uint32_t> RdsDriver::read_scratch(std::uint32_t address, std::size_t count) {
  std::vector<std::uint32_t> words(count);
  if (count > 0) host_.dma_from(kScratchpad + address, words.data(), count, kWordFunction);
  return words;
}

void RdsDriver::write_look_up_table(const std::vector<std::uint32_t>& entries) {
  DENDRO_CHECK(entries.size() == 1024, "{} entries", entries.size());
  host_.dma_to(kLookUpTable, entries.data(), entries.size(), kWordFunction);
}

void RdsDriver::show_byte(unsigned low) {
  std::vector<std::uint32_t> lines;
  for (unsigned output = 0; output < kCrossbarLines; ++output)
    lines.push_back(output < 24 ? low + output % 8 : output);
  route(lines);
}

void RdsDriver::show_colour() {
  std::vector<std::uint32_t> lines;
  for (unsigned output = 0; output < kCrossbarLines; ++output) lines.push_back(output);
  route(lines);
}

void RdsDriver::route(const std::vector<std::uint32_t>& lines) {
  host_.dma_to(kCrossbar, lines.data(), lines.size(), kWordFunction);
  host_.write(kLuvoCrossbar, kLuvoStraight, kWordFunction);
}

void RdsDriver::set_viewport(int width, int height, bool repeat_field) {
  const int lines = repeat_field ? 2 * height : height;
  const auto size = static_cast<std::uint32_t>(width - 1) | static_cast<std::uint32_t>(lines - 1) << 16;
  host_.write(kFrameBufferController + kViewportSize, size, kWordFunction);
}

void RdsDriver::start(std::uint32_t entry) {
  host_.write(kProcessorStatus, entry << 16, kWordFunction);
  host_.command(kRun | kReset);
  host_.command(kRun);
}

void RdsDriver::wait() {
  host_.wait_interrupt();
  host_.command(0);
}

}  // namespace dendro::lib
