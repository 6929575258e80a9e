#include "firmware/lib/mips/dendro.h"

struct sink {
  char* at;
  size_t room; /* with the final 0 */
  size_t length;
};

struct spec {
  int left, zeros, width, precision; /* precision -1: none given */
};

static void put(struct sink* s, char c) {
  if (s->length + 1 < s->room) s->at[s->length] = c;
  ++s->length;
}

/* Sign, digits and what the field's width asks for around them. */
static void field(struct sink* s, const struct spec* f, const char* sign, const char* digits, int count) {
  const int all = (int)strlen(sign) + count;
  if (!f->left && !f->zeros)
    for (int i = all; i < f->width; ++i) put(s, ' ');
  while (*sign) put(s, *sign++);
  if (!f->left && f->zeros)
    for (int i = all; i < f->width; ++i) put(s, '0');
  for (int i = 0; i < count; ++i) put(s, digits[i]);
  if (f->left)
    for (int i = all; i < f->width; ++i) put(s, ' ');
}

/* Digits end at `end`, at least `least` of them; where they begin. */
static char* number(char* end, uint64_t value, unsigned base, int least, int capitals) {
  const char* digits = capitals ? "0123456789ABCDEF" : "0123456789abcdef";
  char* at = end;
  while (value || end - at < least) {
    if (base == 16) {
      *--at = digits[value & 15];
      value >>= 4;
    } else if (value >> 32) { /* nine digits for the price of one long division */
      uint32_t nine = (uint32_t)(value % 1000000000);
      value /= 1000000000;
      for (int i = 0; i < 9; ++i, nine /= 10) *--at = digits[nine % 10];
    } else {
      *--at = digits[(uint32_t)value % 10];
      value = (uint32_t)value / 10;
    }
  }
  return at;
}

static const uint32_t kTens[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000, 1000000000};

/* 0 <= x < 2^63. Writes behind `to`, returns the length. */
static int fixed(char* to, double x, int decimals) {
  uint64_t whole = (uint64_t)x;
  uint64_t rest = (uint64_t)((x - (double)whole) * (double)kTens[decimals] + 0.5);
  if (rest >= kTens[decimals]) {
    rest -= kTens[decimals];
    ++whole;
  }
  char text[48];
  char* const end = text + sizeof text;
  char* at = end;
  if (decimals) {
    at = number(end, rest, 10, decimals, 0);
    *--at = '.';
  }
  at = number(at, whole, 10, 1, 0);
  memcpy(to, at, (size_t)(end - at));
  return (int)(end - at);
}

static int scientific(char* to, double x, int decimals) {
  int exponent = 0;
  while (x >= 10) x /= 10, ++exponent;
  while (x > 0 && x < 1) x *= 10, --exponent;
  int length = fixed(to, x, decimals);
  if (to[0] == '1' && to[1] == '0') { /* rounded up to 10 */
    ++exponent;
    length = fixed(to, 1, decimals);
  }
  to[length++] = 'e';
  to[length++] = exponent < 0 ? '-' : '+';
  if (exponent < 0) exponent = -exponent;
  char text[8];
  const char* at = number(text + 8, (uint64_t)exponent, 10, 2, 0);
  while (at != text + 8) to[length++] = *at++;
  return length;
}

static void real(struct sink* s, struct spec* f, double x, int with_exponent) {
  char text[64];
  const char* sign = x < 0 ? "-" : "";
  if (x < 0) x = -x;
  if (x != x || x > 1.7976931348623157e308) {
    f->zeros = 0;
    field(s, f, sign, x != x ? "nan" : "inf", 3);
    return;
  }
  const int decimals = f->precision < 0 ? 6 : f->precision > 9 ? 9 : f->precision;
  const int length =
      with_exponent || x >= 9223372036854775808.0 ? scientific(text, x, decimals) : fixed(text, x, decimals);
  field(s, f, sign, text, length);
}

static int digits_of(const char** format) {
  int value = 0;
  while (**format >= '0' && **format <= '9') value = value * 10 + *(*format)++ - '0';
  return value;
}

int vsnprintf(char* to, size_t room, const char* format, va_list list) {
  struct sink s = {to, room, 0};
  char text[32];
  char* const end = text + sizeof text;
  for (; *format; ++format) {
    if (*format != '%') {
      put(&s, *format);
      continue;
    }
    struct spec f = {0, 0, 0, -1};
    for (++format; *format == '-' || *format == '0'; ++format) *format == '-' ? (f.left = 1) : (f.zeros = 1);
    if (*format == '*')
      f.width = va_arg(list, int), ++format;
    else
      f.width = digits_of(&format);
    if (*format == '.') {
      ++format;
      if (*format == '*')
        f.precision = va_arg(list, int), ++format;
      else
        f.precision = digits_of(&format);
    }
    int longs = 0;
    for (; *format == 'l' || *format == 'z'; ++format) ++longs;
    const int least = f.precision < 0 ? 1 : f.precision > 20 ? 20 : f.precision;
    switch (*format) {
      case 'd':
      case 'i': {
        const int64_t value = longs > 1 ? va_arg(list, int64_t) : va_arg(list, int32_t);
        const char* at = number(end, value < 0 ? -(uint64_t)value : (uint64_t)value, 10, least, 0);
        field(&s, &f, value < 0 ? "-" : "", at, (int)(end - at));
        break;
      }
      case 'u':
      case 'x':
      case 'X': {
        const uint64_t value = longs > 1 ? va_arg(list, uint64_t) : va_arg(list, uint32_t);
        const char* at = number(end, value, *format == 'u' ? 10 : 16, least, *format == 'X');
        field(&s, &f, "", at, (int)(end - at));
        break;
      }
      case 'p': {
        const char* at = number(end, va_arg(list, uint32_t), 16, 8, 0);
        field(&s, &f, "0x", at, (int)(end - at));
        break;
      }
      case 'c': {
        const char c = (char)va_arg(list, int);
        field(&s, &f, "", &c, 1);
        break;
      }
      case 's': {
        const char* string = va_arg(list, const char*);
        int length = 0;
        while ((f.precision < 0 || length < f.precision) && string[length]) ++length;
        field(&s, &f, "", string, length);
        break;
      }
      case 'f':
      case 'e':
        real(&s, &f, va_arg(list, double), *format == 'e');
        break;
      case '%':
        put(&s, '%');
        break;
      default:
        put(&s, '%');
        if (!*format)
          --format;
        else
          put(&s, *format);
    }
  }
  if (room) to[s.length < room ? s.length : room - 1] = 0;
  return (int)s.length;
}

int snprintf(char* to, size_t room, const char* format, ...) {
  va_list list;
  va_start(list, format);
  const int length = vsnprintf(to, room, format, list);
  va_end(list);
  return length;
}

int printf(const char* format, ...) {
  char text[512];
  va_list list;
  va_start(list, format);
  const int length = vsnprintf(text, sizeof text, format, list);
  va_end(list);
  int at = 0;
  const int all = length < (int)sizeof text ? length : (int)sizeof text - 1;
  while (at < all) {
    const long written = dendro_call(kSysWrite, 1, (long)(text + at), all - at);
    if (written <= 0) return -1;
    at += (int)written;
  }
  return length;
}
