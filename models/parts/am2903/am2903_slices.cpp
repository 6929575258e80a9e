#include "models/parts/am2903/am2903_slices.h"

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::am2903 {
namespace {

// All slices are worked on side by side in one host word: slice k is the nibble at bit 4k.
constexpr std::uint32_t kSliceBit0 = 0x11111111;  // the lowest bit of each slice
constexpr std::uint32_t kGroupBit0 = 0x00010001;  // the lowest bit of the four slices behind one Am2902

constexpr bool bit(std::uint32_t word, unsigned n) { return ((word >> n) & 1) != 0; }

constexpr std::uint32_t shifted_right(std::uint32_t word, bool into31) {
  return (word >> 1) | (std::uint32_t{into31} << 31);
}
constexpr std::uint32_t shifted_left(std::uint32_t word, bool into0) {
  return (word << 1) | std::uint32_t{into0};
}
constexpr std::uint32_t with_bit31(std::uint32_t word, bool value) {
  return (word & 0x7FFFFFFF) | (std::uint32_t{value} << 31);
}

SliceSum function_unit(const SliceInputs& in) {
  const std::uint32_t r = in.r, s = in.s;
  switch (in.func) {
    case bps32::kSpecial:
      return {0xFFFFFFFF, false, false};
    case bps32::kSMinusR:
      return look_ahead_sum(s, ~r, in.carry_in);
    case bps32::kRMinusS:
      return look_ahead_sum(r, ~s, in.carry_in);
    case bps32::kRPlusS:
      return look_ahead_sum(r, s, in.carry_in);
    case bps32::kPassS:
      return look_ahead_sum(s, 0, in.carry_in);
    case bps32::kNotS:
      return look_ahead_sum(~s, 0, in.carry_in);
    case bps32::kPassR:
      return look_ahead_sum(r, 0, in.carry_in);
    case bps32::kNotR:
      return look_ahead_sum(~r, 0, in.carry_in);
    case bps32::kFZero:
      return {0, false, false};
    case bps32::kNotRAndS:
      return {~r & s, false, false};
    case bps32::kXnor:
      return {~(r ^ s), false, false};
    case bps32::kXor:
      return {r ^ s, false, false};
    case bps32::kAnd:
      return {r & s, false, false};
    case bps32::kNor:
      return {~(r | s), false, false};
    case bps32::kNand:
      return {~(r & s), false, false};
    default:
      return {r | s, false, false};
  }
}

// The bit at the end of the shift chain. `ones` and `rotated` are what codes 1 and 2 mean for this kind of
// shift.
bool fill_bit(const SliceInputs& in, bool ones, bool rotated) {
  switch (in.fill) {
    case bps32::kFillZero:
      return false;
    case bps32::kFillSign:
      return ones;
    case bps32::kFillRotate:
      return rotated;
    default:
      return in.latched_carry;
  }
}

void destination(const SliceInputs& in, std::uint32_t f, SliceOutputs& out) {
  const bool f31 = bit(f, 31), q31 = bit(in.q, 31);
  out.f = f;
  out.y = f;
  out.q = in.q;
  out.write_ram = true;
  switch (in.dest) {
    case bps32::kAsrRam:
    case bps32::kLsrRam:
    case bps32::kAsrBoth:
    case bps32::kLsrBoth: {
      const bool both = (in.dest & 2) != 0, arithmetic = (in.dest & 1) == 0;
      const bool fill = fill_bit(in, f31, both ? bit(in.q, 0) : bit(f, 0));
      // The arithmetic shift goes around the top bit: F30 moves to 29 and the fill to 30.
      out.y =
          arithmetic ? with_bit31(shifted_right(with_bit31(f, fill), false), f31) : shifted_right(f, fill);
      if (both) out.q = shifted_right(in.q, bit(f, 0));
      return;
    }
    case bps32::kRam:
    case bps32::kRamAlso:
      return;
    case bps32::kQRight:
      out.q = shifted_right(in.q, fill_bit(in, q31, bit(in.q, 0)));
      out.write_ram = false;
      return;
    case bps32::kQ:
      out.q = f;
      out.write_ram = false;
      return;
    case bps32::kRamQ:
      out.q = f;
      return;
    case bps32::kAslRam:
    case bps32::kLslRam:
    case bps32::kAslBoth:
    case bps32::kLslBoth: {
      const bool both = (in.dest & 2) != 0, arithmetic = (in.dest & 1) == 0;
      const bool fill = fill_bit(in, true, f31);
      out.y = shifted_left(f, both ? q31 : fill);
      if (arithmetic) out.y = with_bit31(out.y, f31);
      if (both) out.q = shifted_left(in.q, fill);
      return;
    }
    case bps32::kYOnly:
      out.write_ram = false;
      return;
    case bps32::kQLeft:
      out.q = shifted_left(in.q, fill_bit(in, true, q31));
      out.write_ram = false;
      return;
    default:
      out.y = fill_bit(in, f31, bit(f, 0)) ? 0xFFFFFFFF : 0;
      return;  // kSignExtend
  }
}

void multiply_step(const SliceInputs& in, bool is_signed, bool last, SliceOutputs& out) {
  const bool z = bit(in.q, 0);
  const std::uint32_t addend = !z ? 0 : last ? ~in.r : in.r;
  const SliceSum sum = look_ahead_sum(in.s, addend, last ? z : in.carry_in);
  out.f = sum.f;
  out.y = shifted_right(sum.f, is_signed ? bit(sum.f, 31) != sum.overflow : sum.carry);
  out.q = shifted_right(in.q, bit(sum.f, 0));
  out.c = sum.carry;
  out.v = sum.overflow;
  out.n = bit(sum.f, 31);
  out.z = out.y == 0;
}

void sign_magnitude(const SliceInputs& in, SliceOutputs& out) {
  const bool z = bit(in.s, 31);
  const SliceSum sum = look_ahead_sum(z ? ~in.s : in.s, 0, z);
  out.f = sum.f;
  out.y = with_bit31(sum.f, z != bit(sum.f, 31));
  out.c = sum.carry;
  out.v = sum.overflow;
  out.n = bit(out.y, 31);
  out.z = out.y == 0;
}

void single_normalise(const SliceInputs& in, SliceOutputs& out) {
  out.f = out.y = look_ahead_sum(in.s, 0, in.carry_in).f;
  out.q = shifted_left(in.q, false);
  out.z = in.q == 0;
  out.n = bit(in.q, 31);
  out.c = bit(in.q, 31) != bit(in.q, 30);
  out.v = bit(in.q, 30) != bit(in.q, 29);
}

void double_normalise(const SliceInputs& in, SliceOutputs& out) {
  const std::uint32_t f = look_ahead_sum(in.s, 0, in.carry_in).f;
  out.f = f;
  out.y = shifted_left(f, bit(in.q, 31));
  out.divide_sign = bit(in.r, 31) == bit(f, 31);
  out.q = shifted_left(in.q, out.divide_sign);
  out.z = f == 0 && in.q == 0;
  out.n = bit(f, 31);
  out.c = bit(f, 31) != bit(f, 30);
  out.v = bit(f, 30) != bit(f, 29);
}

void divide_step(const SliceInputs& in, bool correction, SliceOutputs& out) {
  const SliceSum sum = look_ahead_sum(in.s, in.divide_sign ? ~in.r : in.r, in.divide_sign);
  out.f = sum.f;
  out.y = correction ? sum.f : shifted_left(sum.f, bit(in.q, 31));
  out.divide_sign = bit(in.r, 31) == bit(sum.f, 31);
  out.q = shifted_left(in.q, out.divide_sign);
  out.c = sum.carry;
  out.v = sum.overflow;
  out.n = bit(sum.f, 31);
  out.z = out.y == 0;
}

void special(const SliceInputs& in, SliceOutputs& out) {
  out.q = in.q;
  out.write_ram = true;
  switch (in.dest) {
    case 0x0:
      return multiply_step(in, false, false, out);
    case 0x2:
      return multiply_step(in, true, false, out);
    case 0x4: {
      // +1 or +2: the slices add a constant one and the carry.
      const SliceSum sum = look_ahead_sum(in.s, 1, in.carry_in);
      out.f = out.y = sum.f;
      out.c = sum.carry;
      out.v = sum.overflow;
      out.n = bit(sum.f, 31);
      out.z = sum.f == 0;
      return;
    }
    case 0x5:
      return sign_magnitude(in, out);
    case 0x6:
      return multiply_step(in, true, true, out);
    case 0x8:
      return single_normalise(in, out);
    case 0xA:
      return double_normalise(in, out);
    case 0xC:
      return divide_step(in, false, out);
    case 0xE:
      return divide_step(in, true, out);
    default:
      out.write_ram = false;
      out.z = true;
  }
}

}  // namespace

SliceSum look_ahead_sum(std::uint32_t a, std::uint32_t b, bool carry) {
  const std::uint32_t g = a & b, p = a | b;
  // Generate and propagate of each slice.
  const std::uint32_t slice_g =
      ((g >> 3) | ((p >> 3) & ((g >> 2) | ((p >> 2) & ((g >> 1) | ((p >> 1) & g)))))) & kSliceBit0;
  const std::uint32_t slice_p = p & (p >> 1) & (p >> 2) & (p >> 3) & kSliceBit0;
  // Of each four slices: the Am2902's own generate and propagate outputs.
  const std::uint32_t group_g =
      ((slice_g >> 12) |
       ((slice_p >> 12) &
        ((slice_g >> 8) | ((slice_p >> 8) & ((slice_g >> 4) | ((slice_p >> 4) & slice_g)))))) &
      kGroupBit0;
  const std::uint32_t group_p = slice_p & (slice_p >> 4) & (slice_p >> 8) & (slice_p >> 12) & kGroupBit0;

  const std::uint32_t c0 = carry;
  const std::uint32_t c16 = (group_g | (group_p & c0)) & 1;
  const std::uint32_t c32 = (group_g >> 16) | ((group_p >> 16) & c16);

  const std::uint32_t in0 = c0 | (c16 << 16);
  const std::uint32_t in1 = (slice_g | (slice_p & in0)) & kGroupBit0;
  const std::uint32_t in2 = ((slice_g >> 4) | ((slice_p >> 4) & in1)) & kGroupBit0;
  const std::uint32_t in3 = ((slice_g >> 8) | ((slice_p >> 8) & in2)) & kGroupBit0;
  const std::uint32_t into_slices = in0 | (in1 << 4) | (in2 << 8) | (in3 << 12);

  const std::uint32_t bit1 = (g | (p & into_slices)) & kSliceBit0;
  const std::uint32_t bit2 = ((g >> 1) | ((p >> 1) & bit1)) & kSliceBit0;
  const std::uint32_t bit3 = ((g >> 2) | ((p >> 2) & bit2)) & kSliceBit0;
  const std::uint32_t carries = into_slices | (bit1 << 1) | (bit2 << 2) | (bit3 << 3);
  return {a ^ b ^ carries, c32 != 0, bit(carries, 31) != (c32 != 0)};
}

SliceOutputs evaluate_slices(const SliceInputs& in) {
  SliceOutputs out;
  out.divide_sign = in.divide_sign;
  if (in.func == bps32::kSpecial && !in.i0) {
    special(in, out);
    return out;
  }
  const SliceSum sum = function_unit(in);
  destination(in, sum.f, out);
  out.c = sum.carry;
  out.v = sum.overflow;
  out.n = bit(sum.f, 31);
  out.z = out.y == 0;
  return out;
}

}  // namespace dendro::am2903
