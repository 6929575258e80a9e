#include "models/parts/r3000/r3000_decode.h"

namespace dendro::r3000 {
namespace {

std::uint8_t target(unsigned reg) { return static_cast<std::uint8_t>(reg == 0 ? kNowhere : reg); }

Op special_op(unsigned fn) {
  switch (fn) {
    case kFnSll:
      return Op::kSll;
    case kFnSrl:
      return Op::kSrl;
    case kFnSra:
      return Op::kSra;
    case kFnSllv:
      return Op::kSllv;
    case kFnSrlv:
      return Op::kSrlv;
    case kFnSrav:
      return Op::kSrav;
    case kFnJr:
      return Op::kJr;
    case kFnJalr:
      return Op::kJalr;
    case kFnSyscall:
      return Op::kSyscall;
    case kFnBreak:
      return Op::kBreak;
    case kFnMfhi:
      return Op::kMfhi;
    case kFnMthi:
      return Op::kMthi;
    case kFnMflo:
      return Op::kMflo;
    case kFnMtlo:
      return Op::kMtlo;
    case kFnMult:
      return Op::kMult;
    case kFnMultu:
      return Op::kMultu;
    case kFnDiv:
      return Op::kDiv;
    case kFnDivu:
      return Op::kDivu;
    case kFnAdd:
      return Op::kAdd;
    case kFnAddu:
      return Op::kAddu;
    case kFnSub:
      return Op::kSub;
    case kFnSubu:
      return Op::kSubu;
    case kFnAnd:
      return Op::kAnd;
    case kFnOr:
      return Op::kOr;
    case kFnXor:
      return Op::kXor;
    case kFnNor:
      return Op::kNor;
    case kFnSlt:
      return Op::kSlt;
    case kFnSltu:
      return Op::kSltu;
    default:
      return Op::kReserved;
  }
}

Decoded decode_special(std::uint32_t w) {
  Decoded d;
  d.op = special_op(w & 63);
  d.rs = static_cast<std::uint8_t>(rs_of(w));
  d.rt = static_cast<std::uint8_t>(rt_of(w));
  d.rd = target(rd_of(w));
  d.imm = sa_of(w);
  const bool plain = d.op != Op::kSyscall && d.op != Op::kBreak && d.op != Op::kJalr && d.op != Op::kReserved;
  if (plain && d.op < Op::kMult && d.rd == kNowhere && d.op != Op::kAdd && d.op != Op::kSub) {
    d.op = Op::kNop;
    d.imm = w == 0;
  }
  return d;
}

Decoded decode_regimm(std::uint32_t w) {
  Decoded d;
  d.rs = static_cast<std::uint8_t>(rs_of(w));
  d.imm = 4 + (signed_immediate(w) << 2);
  switch (rt_of(w)) {
    case 0:
      d.op = Op::kBltz;
      break;
    case 1:
      d.op = Op::kBgez;
      break;
    case 16:
      d.op = Op::kBltzal;
      break;
    case 17:
      d.op = Op::kBgezal;
      break;
    default:
      d.op = Op::kReserved;
  }
  return d;
}

Decoded unusable(unsigned cop) {
  Decoded d;
  d.op = Op::kCopUnusable;
  d.rd = static_cast<std::uint8_t>(cop);
  return d;
}

Decoded decode_cop0(std::uint32_t w) {
  Decoded d;
  d.rt = static_cast<std::uint8_t>(rt_of(w));
  d.rd = static_cast<std::uint8_t>(rd_of(w));
  switch (rs_of(w)) {
    case kMfc:
      d.op = Op::kMfc0;
      d.imm = d.rd;
      d.rd = 0;
      d.rt = target(d.rt);
      return d;
    case kMtc:
      d.op = Op::kMtc0;
      return d;
    case kBc:
      d.imm = 4 + (signed_immediate(w) << 2);
      d.op = d.rt == 0 ? Op::kBc0f : d.rt == 1 ? Op::kBc0t : Op::kReserved;
      return d;
    default:
      break;
  }
  if (rs_of(w) < kCopOperation) return d;
  switch (w & 63) {
    case kFnTlbr:
      d.op = Op::kTlbr;
      break;
    case kFnTlbwi:
      d.op = Op::kTlbwi;
      break;
    case kFnTlbwr:
      d.op = Op::kTlbwr;
      break;
    case kFnTlbp:
      d.op = Op::kTlbp;
      break;
    case kFnRfe:
      d.op = Op::kRfe;
      break;
    default:
      break;
  }
  return d;
}

Decoded decode_cop1(std::uint32_t w) {
  Decoded d;
  d.rt = static_cast<std::uint8_t>(rt_of(w));
  d.rd = static_cast<std::uint8_t>(rd_of(w));
  switch (rs_of(w)) {
    case kMfc:
    case kCfc:
      d.op = rs_of(w) == kMfc ? Op::kMfc1 : Op::kCfc1;
      d.imm = d.rd;
      d.rd = 0;
      d.rt = target(d.rt);
      return d;
    case kMtc:
      d.op = Op::kMtc1;
      return d;
    case kCtc:
      d.op = Op::kCtc1;
      return d;
    case kBc:
      d.imm = 4 + (signed_immediate(w) << 2);
      d.op = d.rt == 0 ? Op::kBc1f : d.rt == 1 ? Op::kBc1t : Op::kReserved;
      return d;
    default:
      break;
  }
  if (rs_of(w) < kCopOperation) return d;
  d.op = Op::kFp;
  d.imm = w;
  return d;
}

Op immediate_op(unsigned major) {
  switch (major) {
    case kMajorAddi:
      return Op::kAddi;
    case kMajorAddiu:
      return Op::kAddiu;
    case kMajorSlti:
      return Op::kSlti;
    case kMajorSltiu:
      return Op::kSltiu;
    case kMajorAndi:
      return Op::kAndi;
    case kMajorOri:
      return Op::kOri;
    case kMajorXori:
      return Op::kXori;
    case kMajorLb:
      return Op::kLb;
    case kMajorLh:
      return Op::kLh;
    case kMajorLwl:
      return Op::kLwl;
    case kMajorLw:
      return Op::kLw;
    case kMajorLbu:
      return Op::kLbu;
    case kMajorLhu:
      return Op::kLhu;
    case kMajorLwr:
      return Op::kLwr;
    case kMajorSb:
      return Op::kSb;
    case kMajorSh:
      return Op::kSh;
    case kMajorSwl:
      return Op::kSwl;
    case kMajorSw:
      return Op::kSw;
    case kMajorSwr:
      return Op::kSwr;
    case kMajorLwc1:
      return Op::kLwc1;
    case kMajorSwc1:
      return Op::kSwc1;
    default:
      return Op::kReserved;
  }
}

Decoded decode_immediate(std::uint32_t w) {
  Decoded d;
  const unsigned major = w >> 26;
  d.op = immediate_op(major);
  d.rs = static_cast<std::uint8_t>(rs_of(w));
  d.rt = static_cast<std::uint8_t>(rt_of(w));
  d.imm = signed_immediate(w);
  if (d.op == Op::kAndi || d.op == Op::kOri || d.op == Op::kXori) d.imm = w & 0xFFFF;
  if ((d.op >= Op::kAddi && d.op <= Op::kXori) || is_delayed_load(d.op)) d.rt = target(d.rt);
  return d;
}

Decoded decode_branch(std::uint32_t w) {
  static constexpr Op kOps[] = {Op::kBeq, Op::kBne, Op::kBlez, Op::kBgtz};
  Decoded d;
  d.op = kOps[(w >> 26) - kMajorBeq];
  d.rs = static_cast<std::uint8_t>(rs_of(w));
  d.rt = static_cast<std::uint8_t>(rt_of(w));
  d.imm = 4 + (signed_immediate(w) << 2);
  return d;
}

}  // namespace

Decoded decode(std::uint32_t w) {
  const unsigned major = w >> 26;
  Decoded d;
  switch (major) {
    case kSpecial:
      return decode_special(w);
    case kRegimm:
      return decode_regimm(w);
    case kMajorJ:
    case kMajorJal:
      d.op = major == kMajorJ ? Op::kJ : Op::kJal;
      d.imm = (w & 0x3FFFFFF) << 2;
      return d;
    case kMajorBeq:
    case kMajorBne:
    case kMajorBlez:
    case kMajorBgtz:
      return decode_branch(w);
    case kMajorLui:
      d.op = Op::kLui;
      d.rt = target(rt_of(w));
      d.imm = w << 16;
      return d;
    case kCop0:
      return decode_cop0(w);
    case kCop1:
      return decode_cop1(w);
    case kCop2:
    case kCop3:
      return unusable(major - kCop0);
    case kMajorLwc0 + 2:
    case kMajorSwc0 + 2:
      return unusable(2);
    case kMajorLwc3:
    case kMajorSwc3:
      return unusable(3);
    default:
      return decode_immediate(w);
  }
}

unsigned destination_of(const Decoded& d) {
  const auto real = [](unsigned reg) { return reg == kNowhere ? 0 : reg; };
  if ((d.op >= Op::kSll && d.op <= Op::kSltu) || d.op == Op::kMfhi || d.op == Op::kMflo || d.op == Op::kJalr)
    return real(d.rd);
  if ((d.op >= Op::kAddi && d.op <= Op::kLui) || is_delayed_load(d.op)) return real(d.rt);
  if (d.op == Op::kJal || d.op == Op::kBltzal || d.op == Op::kBgezal) return 31;
  return 0;
}

bool reads(const Decoded& d, unsigned reg) {
  if (reg == 0 || reg == kNowhere) return false;
  const bool three = (d.op >= Op::kSll && d.op <= Op::kSltu) || (d.op >= Op::kMult && d.op <= Op::kDivu);
  const bool two = d.op == Op::kBeq || d.op == Op::kBne;
  const bool store = d.op >= Op::kSb && d.op <= Op::kSwr;
  const bool to_cop = d.op == Op::kMtc0 || d.op == Op::kMtc1 || d.op == Op::kCtc1;
  if ((three || two || store || to_cop) && d.rt == reg) return true;
  const bool no_rs = to_cop || d.op == Op::kMfc0 || d.op == Op::kMfc1 || d.op == Op::kCfc1 ||
                     d.op == Op::kFp || d.op == Op::kLui || d.op == Op::kJ || d.op == Op::kJal ||
                     d.op == Op::kNop || d.op >= Op::kTlbr;
  return !no_rs && d.rs == reg;
}

void decode_page(const std::uint32_t* words, unsigned count, Decoded* out) {
  for (unsigned i = 0; i < count; ++i) out[i] = decode(words[i]);
  for (unsigned i = 0; i < count; ++i)
    if (is_delayed_load(out[i].op))
      out[i].rd = i == 0 || i + 1 == count || is_branch(out[i - 1].op) || reads(out[i + 1], out[i].rt);
}

}  // namespace dendro::r3000
