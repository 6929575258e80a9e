#include "models/parts/bps32/bps32_disasm.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::bps32 {
namespace {

using Text = std::optional<std::string>;

constexpr const char* kFillNames[] = {"", " sign", " rotate", " carry"};
constexpr const char* kSpecialNames[16] = {
    "umul_step", nullptr, "smul_step",        nullptr, "increment", "sign_magnitude", "smul_last",   nullptr,
    "normalize", nullptr, "double_normalize", nullptr, "div_step",  nullptr,          "div_correct", nullptr};

bool one_operand(unsigned dest) { return dest == 4 || dest == 5 || dest == 8; }

std::string register_name(unsigned r) { return fmt::format("r{}", r); }

class Printer {
 public:
  Printer(std::uint64_t word, const AddressName& name) : w_(word), name_(name) {}

  std::string text() {
    const bool fits = alu() && bus() && multiply() && sequencer();
    if (!fits) return fmt::format("word 0x{:016x}", w_);
    if (get(w_, kHalt)) parts_.push_back("halt");
    std::string all;
    for (const std::string& p : parts_) all += (all.empty() ? "" : ", ") + p;
    return all.empty() ? "nop" : all;
  }

 private:
  std::string address(unsigned a) const {
    const std::string name = name_ ? name_(a) : "";
    return name.empty() ? fmt::format("0x{:03x}", a) : name;
  }

  Text d_operand() const {
    std::string source;
    switch (get(w_, kDsrc)) {
      case kDSpad:
        source = fmt::format("spad[0x{:03x}]", get(w_, kImm));
        break;
      case kDSpadAr:
        source = "spad[sar]";
        break;
      case kDSpadArInc:
        source = "spad[sar++]";
        break;
      case kDImm:
        source = fmt::format("#{}", base::sign_extend(get(w_, kImm), 12));
        break;
      default:
        if (!kDsrcNames[get(w_, kDsrc)]) return std::nullopt;
        source = kDsrcNames[get(w_, kDsrc)];
        break;
    }
    const unsigned lane = get(w_, kLane);
    return lane ? fmt::format("ror{}({})", 8 * lane, source) : source;
  }

  Text r_operand() const { return get(w_, kEa) ? d_operand() : Text(register_name(get(w_, kA))); }
  Text s_operand() const {
    if (get(w_, kI0)) return "q";
    return get(w_, kOeb) ? d_operand() : Text(register_name(get(w_, kB)));
  }

  /// Carry-in after a sum; `minus` for a subtraction.
  std::string carry(bool minus) const {
    static constexpr const char* kPlus[] = {"", " + 1", " + carry", " + !carry"};
    static constexpr const char* kMinus[] = {" - 1", "", " - borrow", " - carry"};
    return minus ? kMinus[get(w_, kCarry)] : kPlus[get(w_, kCarry)];
  }

  Text special() const {
    const unsigned dest = get(w_, kDest);
    const Text s = s_operand();
    const Text r = r_operand();
    if (!kSpecialNames[dest] || !s || !r) return std::nullopt;
    const std::string operands = one_operand(dest) ? *s : *s + ", " + *r;
    return fmt::format("{}({}){}", kSpecialNames[dest], operands, carry(false));
  }

  Text function() const {
    const unsigned func = get(w_, kFunc);
    if (func == kFZero) return "0";
    if (func == kSpecial) return get(w_, kI0) ? Text("-1") : special();
    const bool needs_r = func != kPassS && func != kNotS;
    const bool needs_s = func != kPassR && func != kNotR;
    const Text r = needs_r ? r_operand() : Text("");
    const Text s = needs_s ? s_operand() : Text("");
    if (!r || !s) return std::nullopt;
    switch (func) {
      case kSMinusR:
        if (*r == "none" && get(w_, kCarry) == kCarryZero) return *s + " - 1";
        return *s + " - " + *r + carry(true);
      case kRMinusS:
        return *r + " - " + *s + carry(true);
      case kRPlusS:
        return *s + " + " + *r + carry(false);
      case kPassS:
        return *s + carry(false);
      case kNotS:
        return "~" + *s + carry(false);
      case kPassR:
        return *r + carry(false);
      case kNotR:
        return "~" + *r + carry(false);
      case kNotRAndS:
        return "~" + *r + " & " + *s;
      case kXnor:
        return "~(" + *s + " ^ " + *r + ")";
      case kXor:
        return *s + " ^ " + *r;
      case kAnd:
        return *s + " & " + *r;
      case kNor:
        return "~(" + *s + " | " + *r + ")";
      case kNand:
        return "~(" + *s + " & " + *r + ")";
      default:
        return *s + " | " + *r;
    }
  }

  /// The places that the result goes to, as `a = b = `, and the shifted expression.
  bool alu() {
    const unsigned dest = get(w_, kDest);
    const bool special = get(w_, kFunc) == kSpecial && !get(w_, kI0);
    const Text f = function();
    const Text y = y_destination();
    if (!f || !y) return false;
    std::string places = *y;
    const std::string reg = register_name(get(w_, kB));
    const std::string fill = kFillNames[get(w_, kFill)];
    std::string value = *f;
    if (special) {
      places += dest == 4 || dest == 5 ? reg + " = " : reg + ":q = ";
    } else if (dest <= kLsrBoth || (dest >= kAslRam && dest <= kLslBoth)) {
      const bool pair = dest & 2;
      places += reg + (pair ? ":q = " : " = ");
      value = fmt::format("({}) {} 1{}{}", value, dest < 8 ? ">>" : "<<", fill, dest & 1 ? "" : " keep");
    } else if (dest == kSignExtend) {
      places += reg + " = ";
      value = fmt::format("spread({},{})", value, get(w_, kFill) ? fill : " zero");
    } else if (dest == kQRight || dest == kQLeft) {
      parts_.push_back(fmt::format("q = q {} 1{}", dest == kQRight ? ">>" : "<<", fill));
    } else {
      if (dest == kRam || dest == kRamQ || dest == kRamAlso) places += reg + " = ";
      if (dest == kQ || dest == kRamQ) places += "q = ";
    }
    const bool latch = get(w_, kLatch);
    if (!places.empty()) {
      parts_.push_back(places + value);
      if (latch) parts_.push_back("flags");
    } else if (latch) {
      parts_.push_back(value + " -> flags");
    } else if (get(w_, kFunc) != kFZero) {
      return false;  // a result that goes nowhere has no form
    }
    return true;
  }

  Text y_destination() const {
    switch (get(w_, kYdst)) {
      case kYNone:
        return "";
      case kYSpad:
        return fmt::format("spad[0x{:03x}] = ", get(w_, kImm));
      case kYSpadAr:
        return "spad[sar] = ";
      case kYSpadArInc:
        return "spad[sar++] = ";
      default:
        if (!kYdstNames[get(w_, kYdst)]) return std::nullopt;
        return std::string(kYdstNames[get(w_, kYdst)]) + " = ";
    }
  }

  bool bus() {
    const unsigned op = get(w_, kBusOp);
    if (op == kBusIdle) return true;
    if (op == kBusReserved) return false;
    static constexpr const char* kNames[16] = {"word",      nullptr, "lores",      "hires",
                                               nullptr,     nullptr, nullptr,      nullptr,
                                               "mask_word", nullptr, "mask_lores", "mask_hires"};
    const unsigned fn = get(w_, kBusFn);
    parts_.push_back(std::string(op == kBusRead ? "read " : "write ") +
                     (kNames[fn] ? kNames[fn] : fmt::format("{}", fn)));
    return true;
  }

  bool multiply() {
    const unsigned m = get(w_, kMul);
    if (m == kMulReserved) return false;
    if (m != kMulNone) parts_.push_back(m == kMulSigned ? "mul signed" : "mul unsigned");
    return true;
  }

  bool sequencer() {
    const unsigned op = get(w_, kSeq);
    const unsigned cond = get(w_, kCond);
    const bool inverted = get(w_, kPol);
    const bool plain_push = op == am2910::kPUSH && cond == kAlways && inverted && !get(w_, kImm);
    if (op == am2910::kCONT && cond == kAlways && !inverted) return true;
    std::string text = plain_push || (cond == kAlways && !inverted)
                           ? ""
                           : fmt::format("if ({}{}) ", inverted ? "!" : "", condition(cond));
    text += op == am2910::kCJP    ? "goto"
            : op == am2910::kCJS  ? "call"
            : op == am2910::kCRTN ? "return"
                                  : am2910::kOpNames[op];
    const bool takes_input = op != am2910::kJZ && op != am2910::kRFCT && op != am2910::kCRTN &&
                             op != am2910::kLOOP && op != am2910::kCONT && !plain_push;
    if (takes_input) {
      const bool number = op == am2910::kLDCT || op == am2910::kPUSH;
      text += get(w_, kYdst) == kYSeq ? " seq"
              : number                ? fmt::format(" {}", get(w_, kImm))
                                      : " " + address(get(w_, kImm));
    }
    parts_.push_back(text);
    return true;
  }

  std::string condition(unsigned cond) const {
    const bool flag = (cond >= kZero && cond <= kLessEqual) || cond == kLowerEqual;
    const bool latched = get(w_, kLatch) || get(w_, kYdst) == kYStatus;
    return flag && latched ? fmt::format("old({})", kCondNames[cond]) : kCondNames[cond];
  }

  std::uint64_t w_;
  const AddressName& name_;
  std::vector<std::string> parts_;
};

}  // namespace

std::string disassemble_word(std::uint64_t word, const AddressName& name) {
  return Printer(word, name).text();
}

}  // namespace dendro::bps32
