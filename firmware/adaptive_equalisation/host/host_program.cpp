#include "firmware/adaptive_equalisation/host/host_program.h"

namespace dendro::adaptive_equalisation {
namespace {

Work instructions(std::uint64_t count) {
  Work work;
  work.instructions = count;
  return work;
}

class Equalisation {
 public:
  Equalisation(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site)
      : host_(host), driver_(host, programs), prepared_(prepared), site_(site) {}

  void set_up() {
    host_.phase("load_program");
    driver_.load();
    host_.phase("set_up");
    driver_.show(prepared_.layout.colour(), prepared_.width, prepared_.height);
    for (const auto& [name, value] : prepared_.layout.registers()) driver_.set_register(name, value);
    if (site_.renderers > 1) driver_.select(0);
    driver_.run("clear");
  }

  void load_picture() {
    host_.phase("load_picture");
    for (int y = 0; y < prepared_.height; ++y) {
      span("load_row_first", "load_row_last", 0, 1, {y, y});
      for (int x = 0; x < prepared_.width; ++x) {
        host_.compute(instructions(kInstructionsGrey));
        send("load_pixel", 1, 0, -x, grey(x, y));
      }
    }
  }

  void rank() {
    host_.phase("rank");
    for (int y = 0; y < prepared_.height; ++y) {
      const Span rows = pixels_that_see(y, prepared_.region, prepared_.height);
      host_.compute(instructions(kInstructionsBound));
      if (prepared_.method == Method::kRows) span("row_first", "row_last", 0, 1, rows);
      for (int x = 0; x < prepared_.width; ++x) {
        host_.compute(instructions(kInstructionsGrey + kInstructionsBound));
        span("region_first", "region_edge", 1, 0, pixels_that_see(x, prepared_.region, prepared_.width));
        if (prepared_.method == Method::kPolygon) {
          send("region_edge", 0, 1, -rows.first);
          send("region_edge", 0, -1, rows.last);
        }
        driver_.run(prepared_.method == Method::kRows ? "count_in_row" : "count", grey(x, y));
      }
    }
  }

  void show() {
    driver_.run("show_ranks");
    if (site_.draws_tiles()) driver_.copy_tile(0, 0);
    host_.phase("finish");
    driver_.wait();
  }

 private:
  /// at least span.first, and at most span.last, along the axis (a, b).
  void span(const char* first, const char* last, int a, int b, const Span& span) {
    send(first, a, b, -span.first);
    send(last, -a, -b, span.last);
  }

  void send(const char* program, int a, int b, int c, std::optional<std::uint64_t> constant = std::nullopt) {
    const lib::Expression expression{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
    driver_.run(program, expression, 0, lib::signed_bits(a, b, c, site_.width, site_.height), constant);
  }

  std::uint64_t grey(int x, int y) const { return prepared_.grey[static_cast<std::size_t>(y * prepared_.width + x)]; }

  HostPort& host_;
  lib::IgcDriver driver_;
  const Prepared& prepared_;
  lib::ArraySite site_;
};

}  // namespace

void run(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site) {
  Equalisation run(host, prepared, programs, site);
  run.set_up();
  run.load_picture();
  run.rank();
  run.show();
}

}  // namespace dendro::adaptive_equalisation
