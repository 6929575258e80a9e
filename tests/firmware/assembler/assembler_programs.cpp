#include "tests/firmware/assembler/assembler_programs.h"

#include <fmt/format.h>

#include <random>
#include <vector>

namespace dendro::testing {
namespace {

class Generator {
 public:
  Generator(std::uint32_t seed, int ticks) : random_(seed), ticks_(ticks), distance_(ticks) {}

  std::string run(bool structured) {
    text_ = "scratch a[8] = {1, 2, 3} @ 16; scratch b[4];\nconst wide = 0x12345678;\nentry main;\n";
    if (structured) {
      text_ += "sub:\n";
      distance_ = ticks_;
      stretch(4);
      settle();
      text_ += "return;\n";
    }
    text_ += "main:\n  r0 - r1 -> flags;\n";
    const int stretches = structured ? 4 : 1;
    for (int i = 0; i < stretches; ++i) {
      stretch(structured ? 12 : 30);
      if (structured) control(i);
    }
    line("halt");
    return text_;
  }

 private:
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  std::string one_of(const std::vector<const char*>& v) {
    return v[static_cast<std::size_t>(pick(static_cast<int>(v.size())))];
  }
  std::string reg() { return fmt::format("r{}", pick(6)); }

  void line(const std::string& s) {
    text_ += "  " + s + ";\n";
    ++distance_;
  }
  void settle() {
    while (distance_ < ticks_) line("nop");
  }

  std::string condition() {
    return (pick(2) ? "!" : "") +
           one_of({"zero", "negative", "carry", "overflow", "less", "less_equal", "lower_equal"});
  }

  void control(int i) {
    const std::string label = fmt::format("l{}", i);
    switch (pick(6)) {
      case 0:
        if (pick(2)) {
          settle();
          line("mul signed");
          distance_ = 1;
        }
        text_ += label + ":\n";
        if (pick(2)) line("nop");
        if (pick(2)) text_ += label + "_too:\n";
        settle();
        line("r2 = product");
        return;
      case 1:
        line("goto " + label);
        text_ += label + ":\n";
        return;
      case 2:
        settle();
        text_ += "  if (" + condition() + ") {\n";
        stretch(5);
        settle();
        text_ += "  } else {\n";
        stretch(5);
        settle();
        text_ += "  }\n";
        return;
      case 3:
        settle();
        // The counter is the loop's: no other stretch may load it.
        in_loop_ = true;
        text_ += fmt::format("  for {} {{\n", 1 + pick(4));
        stretch(8);
        settle();
        text_ += "  }\n";
        in_loop_ = false;
        return;
      case 4:
        settle();
        // Its subroutine may load the counter, but no loop is open here.
        line(pick(2) ? "call sub" : "if (" + condition() + ") call sub");
        return;
      default:
        settle();
        line(fmt::format("if ({}) goto {}", pick(2) ? condition() : "q0", label));
        stretch(4);
        settle();
        text_ += label + ":\n";
        return;
    }
  }

  void stretch(int n) {
    for (int i = 0; i < n; ++i) statement();
  }

  /// A D bus source; settles when it is the product.
  std::string bus_source() {
    const std::string s =
        one_of({"bus", "bus", "a[1]", "a[2]", "b[0]", "spad[sar]", "spad[sar++]", "product", "product_hi",
                "product_lo", "counter", "status", "bus_address", "sar", "#7", "wide", "0x40000"});
    if (s.compare(0, 7, "product") == 0) settle();
    const bool turns = s[0] != 'w' && s[0] != '0';
    return turns && pick(5) == 0 ? one_of({"ror8", "ror16", "ror24"}) + "(" + s + ")" : s;
  }

  std::string carry() { return pick(4) ? "" : one_of({" + 1", " + carry", " + !carry"}); }

  /// An expression whose S operand may be `d`.
  std::string expression(const std::string& d) {
    switch (pick(10)) {
      case 0:
        return reg();
      case 1:
        return bus_source();
      case 2:
        return d + " + " + reg() + carry();
      case 3:
        return d + " - " + bus_source();
      case 4:
        return reg() + " - " + d + (pick(3) ? "" : " - borrow");
      case 5:
        return bus_source() + one_of({" & ", " | ", " ^ "}) + reg();
      case 6:
        return "~" + reg() + " & " + d;
      case 7:
        return "q + " + reg() + carry();
      case 8:
        return "~" + d + carry();
      default:
        return d + " - 1";
    }
  }

  /// A Y destination of the same stretch that others read soon.
  std::string place() {
    return one_of({"bus_x", "bus_x", "bus_y", "bus_address", "bus_data", "bus_data", "a[1]", "a[3]", "b[0]",
                   "spad[sar]", "spad[sar++]", "sar", "mul_x", "mul_x_hi", "mul_y"});
  }

  std::string access() {
    return one_of({"read", "read", "write"}) + one_of({" lores", " word", " hires", " mask_lores", " 5"});
  }

  bool uses_imm(const std::string& s) const {
    return s.find_first_of("#[w") != std::string::npos || s.find("0x") != std::string::npos;
  }

  void transfer() {
    const std::string d = reg();
    const std::string e = expression(d);
    switch (pick(8)) {
      case 0:
        return line(e + " -> flags");
      case 1: {
        const std::string p = place();
        return line(uses_imm(p) && uses_imm(e) ? d + " = " + e : p + " = " + d + " = " + e);
      }
      case 2: {
        const std::string p = place();
        return line(p + " = " + reg());
      }
      case 3:
        return line((pick(2) ? "q = " : d + " = q = ") + e);
      case 4:
        return line(d + " = " + e + ", " + access());
      default:
        return line(d + " = " + e + (pick(3) ? "" : ", flags"));
    }
  }

  void statement() {
    const std::string d = reg();
    switch (pick(18)) {
      case 0:
        return line(access());
      case 1:
        settle();
        line(pick(2) ? "mul signed" : "mul_y = " + reg() + ", mul unsigned");
        distance_ = 1;
        return;
      case 2:
        settle();
        return line(d + " = product");
      case 3:
        return line(fmt::format("{}{} = ({} + {}){} 1{}", d, pick(2) ? ":q" : "", d, reg(),
                                pick(2) ? " >>" : " <<",
                                one_of({"", " sign", " rotate", " carry", " sign keep"})));
      case 4:
        return line(
            d + ":q = " +
            one_of({"umul_step", "smul_step", "smul_last", "double_normalize", "div_step", "div_correct"}) +
            "(" + d + ", " + reg() + ")" + carry());
      case 5:
        return line(one_of({"q = q >> 1 rotate", "q = q << 1", "bus_x = r2, q = q >> 1 sign"}));
      case 6:
        if (in_loop_) return line("nop");
        return line(pick(2) ? "counter = 77" : "counter = " + reg());
      case 7:
        return line("nop");
      case 8:
        return line("status = " + reg());
      case 13:
        // Tests of what the word itself changes: the sequencer sees the state before.
        settle();
        if (pick(2)) {
          line("read lores");
          line(fmt::format("q = q >> 1 rotate, if (q0) goto t{}", targets_));
        } else {
          line(fmt::format("{0} = {0} + 1, flags, if ({1}old({2})) goto t{3}", d, pick(2) ? "!" : "",
                           one_of({"zero", "negative", "carry"}), targets_));
        }
        line(fmt::format("r1 = r1 ^ {}", 64 + targets_));
        text_ += fmt::format("t{}:\n", targets_++);
        return;
      case 9:
        return line(d + " = spread(" + reg() + ", " + one_of({"sign", "carry", "rotate"}) + ")");
      case 10:
        return line(access());
      case 11:
        return line(d + " = bus");
      case 12:
        return line(place() + " = " + d + " = bus");
      default:
        return transfer();
    }
  }

  std::mt19937 random_;
  int ticks_;
  int distance_;  // words since the last multiplication's start
  bool in_loop_ = false;
  int targets_ = 0;
  std::string text_;
};

}  // namespace

std::string random_source(std::uint32_t seed, int multiply_ticks, bool structured) {
  return Generator(seed, multiply_ticks).run(structured);
}

}  // namespace dendro::testing
