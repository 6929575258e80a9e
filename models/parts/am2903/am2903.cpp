#include "models/parts/am2903/am2903.h"

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::am2903 {
namespace {

using namespace bps32;

struct Sum {
  std::uint32_t f;
  bool c, v;
};

Sum add(std::uint32_t a, std::uint32_t b, bool carry) {
  const std::uint64_t wide = std::uint64_t{a} + b + carry;
  const std::uint32_t f = static_cast<std::uint32_t>(wide);
  return {f, (wide >> 32) != 0, (((a ^ f) & (b ^ f)) >> 31) != 0};
}

Sum function(unsigned func, const Input& in) {
  switch (func) {
    case kSpecial: return {0xFFFFFFFF, false, false};
    case kSMinusR: return add(in.s, ~in.r, in.carry_in);
    case kRMinusS: return add(in.r, ~in.s, in.carry_in);
    case kRPlusS: return add(in.r, in.s, in.carry_in);
    case kPassS: return add(in.s, 0, in.carry_in);
    case kNotS: return add(~in.s, 0, in.carry_in);
    case kPassR: return add(in.r, 0, in.carry_in);
    case kNotR: return add(~in.r, 0, in.carry_in);
    case kFZero: return {0, false, false};
    case kNotRAndS: return {~in.r & in.s, false, false};
    case kXnor: return {~(in.r ^ in.s), false, false};
    case kXor: return {in.r ^ in.s, false, false};
    case kAnd: return {in.r & in.s, false, false};
    case kNor: return {~(in.r | in.s), false, false};
    case kNand: return {~(in.r & in.s), false, false};
    default: return {in.r | in.s, false, false};
  }
}

constexpr bool bit(std::uint32_t word, unsigned i) { return (word >> i) & 1; }
constexpr std::uint32_t top(bool b) { return std::uint32_t{b} << 31; }

Output special(unsigned code, const Input& in) {
  Output out{0, in.q, true, true, false, false, false, in.divide_sign};
  Sum sum{0, false, false};
  bool flags_done = false;
  const auto divide = [&] {
    sum = in.divide_sign ? add(in.s, ~in.r, true) : add(in.s, in.r, false);
    out.divide_sign = bit(in.r, 31) == bit(sum.f, 31);
    out.q = in.q << 1 | out.divide_sign;
  };
  switch (code) {
    case 0x0:
    case 0x2: {
      sum = add(in.s, in.q & 1 ? in.r : 0, in.carry_in);
      const bool sign = code == 0 ? sum.c : bit(sum.f, 31) != sum.v;
      out.y = top(sign) | sum.f >> 1;
      out.q = top(sum.f & 1) | in.q >> 1;
      break;
    }
    case 0x4:
      sum = add(in.s, 1, in.carry_in);
      out.y = sum.f;
      break;
    case 0x5:
      sum = bit(in.s, 31) ? add(~in.s, 0, true) : add(in.s, 0, false);
      out.y = bit(in.s, 31) ? sum.f ^ 0x80000000u : sum.f;
      out.n = bit(out.y, 31);
      out.z = out.y == 0;
      out.c = sum.c;
      out.v = sum.v;
      flags_done = true;
      break;
    case 0x6:
      sum = in.q & 1 ? add(in.s, ~in.r, true) : add(in.s, 0, false);
      out.y = top(bit(sum.f, 31) != sum.v) | sum.f >> 1;
      out.q = top(sum.f & 1) | in.q >> 1;
      break;
    case 0x8:
      sum = add(in.s, 0, in.carry_in);
      out.y = sum.f;
      out.q = in.q << 1;
      out.z = in.q == 0;
      out.n = bit(in.q, 31);
      out.c = bit(in.q, 31) != bit(in.q, 30);
      out.v = bit(in.q, 30) != bit(in.q, 29);
      flags_done = true;
      break;
    case 0xA:
      sum = add(in.s, 0, in.carry_in);
      out.y = sum.f << 1 | in.q >> 31;
      out.divide_sign = bit(in.r, 31) == bit(sum.f, 31);
      out.q = in.q << 1 | out.divide_sign;
      out.z = sum.f == 0 && in.q == 0;
      out.n = bit(sum.f, 31);
      out.c = bit(sum.f, 31) != bit(sum.f, 30);
      out.v = bit(sum.f, 30) != bit(sum.f, 29);
      flags_done = true;
      break;
    case 0xC:
      divide();
      out.y = sum.f << 1 | in.q >> 31;
      break;
    case 0xE:
      divide();
      out.y = sum.f;
      break;
    default:
      out.ram_written = false;
      return out;
  }
  if (!flags_done) {
    out.z = out.y == 0;
    out.n = bit(sum.f, 31);
    out.c = sum.c;
    out.v = sum.v;
  }
  return out;
}

bool right_fill(unsigned fill, bool sign, bool out_bit, bool carry) {
  switch (fill) {
    case kFillZero: return false;
    case kFillSign: return sign;
    case kFillRotate: return out_bit;
    default: return carry;
  }
}

bool left_fill(unsigned fill, bool out_bit, bool carry) {
  switch (fill) {
    case kFillZero: return false;
    case kFillSign: return true;
    case kFillRotate: return out_bit;
    default: return carry;
  }
}

}  // namespace

Output operate(const Control& control, const Input& in) {
  if (control.func == kSpecial && !control.i0) return special(control.dest, in);
  const Sum sum = function(control.func, in);
  const std::uint32_t f = sum.f;
  const bool f31 = bit(f, 31), f0 = f & 1, carry = in.latched_carry;
  Output out{f, in.q, true, false, f31, sum.c, sum.v, in.divide_sign};
  switch (control.dest) {
    case kAsrRam:
    case kLsrRam:
    case kAsrBoth:
    case kLsrBoth: {
      const bool both = control.dest >= kAsrBoth;
      const bool fill = right_fill(control.fill, f31, both ? in.q & 1 : f0, carry);
      const bool arithmetic = control.dest == kAsrRam || control.dest == kAsrBoth;
      out.y = arithmetic ? top(f31) | std::uint32_t{fill} << 30 | ((f >> 1) & 0x3FFFFFFF) : top(fill) | f >> 1;
      if (both) out.q = top(f0) | in.q >> 1;
      break;
    }
    case kRam:
    case kRamAlso: break;
    case kQRight:
      out.q = top(right_fill(control.fill, bit(in.q, 31), in.q & 1, carry)) | in.q >> 1;
      out.ram_written = false;
      break;
    case kQ:
      out.q = f;
      out.ram_written = false;
      break;
    case kRamQ: out.q = f; break;
    case kAslRam:
    case kLslRam:
    case kAslBoth:
    case kLslBoth: {
      const bool both = control.dest >= kAslBoth;
      const bool fill = left_fill(control.fill, f31, carry);
      const bool in_bit = both ? bit(in.q, 31) : fill;
      const bool arithmetic = control.dest == kAslRam || control.dest == kAslBoth;
      out.y = f << 1 | in_bit;
      if (arithmetic) out.y = (out.y & 0x7FFFFFFF) | top(f31);
      if (both) out.q = in.q << 1 | fill;
      break;
    }
    case kYOnly: out.ram_written = false; break;
    case kQLeft:
      out.q = in.q << 1 | left_fill(control.fill, bit(in.q, 31), carry);
      out.ram_written = false;
      break;
    default: out.y = right_fill(control.fill, f31, f0, carry) ? 0xFFFFFFFF : 0; break;
  }
  out.z = out.y == 0;
  return out;
}

}  // namespace dendro::am2903
