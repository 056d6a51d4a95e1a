// sim_node/engine/expressions/elementary_functions.h -- exp, log, sin, cos, tanh and powers, with
// the same bits everywhere.
//
// They are made of + - * / and the bits of a number alone: every library of a machine rounds in its
// own way. The parameter `Owner` is a type of an unnamed namespace, such as the lanes of one vector
// width. Each file that includes them has its own copy, which the linker never mixes up with
// another's; see matter/step_kernel.h. The error is below 1.5 units in the last place. The error of
// a whole power grows with its exponent.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cordis::engine {

/// The largest whole exponent of a power that is made by multiplication alone.
inline constexpr int kMaxWholePower = 64;
/// The largest size of an angle [rad] that a few products reduce; a larger one takes more of them.
inline constexpr double kMaxShortAngle = 1048576.0;

template <class Owner>
struct ElementaryFunctions {
  static double exp(double x) noexcept { return exp_of_sum(x, 0.0); }

  static double log(double x) noexcept {
    if (!(x > 0.0)) return x == 0.0 ? -kInfinity : kNan;
    if (x == kInfinity) return x;
    const Scaled number = scaled(x);
    const double f = number.fraction - 1.0;
    const double s = f / (2.0 + f);
    const double z = s * s;
    const double rest = z * polynomial(kLog, z);
    const double half_square = 0.5 * f * f;
    const double k = number.exponent;
    return k * kLn2High - ((half_square - (s * (half_square + rest) + k * kLn2Low)) - f);
  }

  static double sin(double x) noexcept {
    if (size(x) < 0x1p-27) return x;
    if (!(size(x) < kInfinity)) return kNan;
    return sin_of_quarter(reduced(x), 0);
  }

  static double cos(double x) noexcept {
    if (!(size(x) < kInfinity)) return kNan;
    return sin_of_quarter(reduced(x), 1);
  }

  static double tanh(double x) noexcept {
    const double a = size(x);
    if (!(a >= 0x1p-28)) return x;
    if (a < 0.55) {
      const double z = x * x;
      return x + x * (z * polynomial(kTanh, z));
    }
    const double of_size = a < 22.0 ? 1.0 - 2.0 / (exp(2.0 * a) + 1.0) : 1.0;
    return x < 0.0 ? -of_size : of_size;
  }

  /// x^n by multiplication, for n from -kMaxWholePower to kMaxWholePower.
  static double whole_power(double x, double n) noexcept {
    double power = 1.0;
    for (auto left = static_cast<std::uint32_t>(size(n)); left != 0; left >>= 1) {
      if ((left & 1U) != 0) power *= x;
      x *= x;
    }
    return n < 0.0 ? 1.0 / power : power;
  }

  /// x^y, with the special values of IEEE 754.
  static double power(double x, double y) noexcept {
    const double whole =
        size(y) < kFirstWhole ? static_cast<double>(static_cast<std::int64_t>(y)) : y;
    if (whole == y && size(y) <= kMaxWholePower) return whole_power(x, y);
    if (x == 1.0) return x;
    if (x != x || y != y) return kNan;
    const double a = size(x);
    const bool is_odd =
        whole == y && size(y) < kFirstWhole && (static_cast<std::int64_t>(y) & 1) != 0;
    const bool is_negative = (bits_of(x) >> 63) != 0;
    const double sign = is_negative && is_odd ? -1.0 : 1.0;
    if (a == 1.0 && (whole == y)) return sign;
    if (a == 0.0 || a == kInfinity || size(y) > 0x1p65) {
      return sign * ((a > 1.0) == (y > 0.0) ? kInfinity : 0.0);
    }
    if (is_negative && whole != y) return kNan;
    const Sum log = log_of(a);
    const Sum exponent = product(y, log.high);
    return sign * exp_of_sum(exponent.high, exponent.low + y * log.low);
  }

 private:
  /// An unevaluated sum: `low` is what `high` lacks.
  struct Sum {
    double high;
    double low;
  };
  /// fraction * 2^exponent, with the fraction between the roots of 1/2 and 2.
  struct Scaled {
    double fraction;
    int exponent;
  };
  /// An angle less a number of quarter turns.
  struct Reduced {
    Sum rest;
    std::uint32_t quarters;
  };
  /// A whole number below 2^192, its highest digit first.
  struct Digits {
    std::uint64_t of_32_bits[6];
  };

  static constexpr double kInfinity = __builtin_huge_val();
  static constexpr double kNan = __builtin_nan("");
  static constexpr double kFirstWhole = 0x1p53;  // from here on every number is even
  static constexpr double kRounder = 0x1.8p52;   // x + it - it is x, rounded to a whole number
  static constexpr double kLn2High = 0x1.62e42feep-1;  // 32 bits: its products with exponents are
                                                       // exact
  static constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  static constexpr double kTwoThirdsLow = 0x1.5555555555555p-55;
  // pi / 2 in parts of 33 bits, and the rest: their products with whole numbers up to 2^20 are exact
  static constexpr double kQuarter[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                                         0x1.b839a252049c1p-104};
  static constexpr double kQuarterHigh = 0x1.921fb54442d18p+0;  // pi / 2 in two parts
  static constexpr double kQuarterLow = 0x1.1a62633145c07p-54;
  static constexpr std::uint64_t kLowHalf = 0xffffffffU;
  // Behind 64 zeros the binary places of 2 / pi, of which the largest number asks for 1162.
  static constexpr std::uint64_t kPerQuarter[20] = {
      0x0000000000000000U, 0xa2f9836e4e441529U, 0xfc2757d1f534ddc0U, 0xdb6295993c439041U,
      0xfe5163abdebbc561U, 0xb7246e3a424dd2e0U, 0x06492eea09d1921cU, 0xfe1deb1cb129a73eU,
      0xe88235f52ebb4484U, 0xe99c7026b45f7e41U, 0x3991d639835339f4U, 0x9c845f8bbdf9283bU,
      0x1ff897ffde05980fU, 0xef2f118b5a0a6d1fU, 0x6d367ecf27cb09b7U, 0x4f463f669e5fea2dU,
      0x7527bac7ebe5f17bU, 0x3d0739f78a5292eaU, 0x6bfb5fb11f8d5d08U, 0x56033046fc7b6babU};

  // Coefficients of Chebyshev approximations, lowest power first.
  // (e^x - 1 - x) / x^2 over x, |x| <= ln 2 / 2
  static constexpr double kExp[11] = {0.5,
                                      0.1666666666666667,
                                      0.04166666666666667,
                                      0.008333333333326084,
                                      0.0013888888888883711,
                                      0.0001984126987500228,
                                      2.480158732567746e-05,
                                      2.755725517000089e-06,
                                      2.755727347871858e-07,
                                      2.5105312729622103e-08,
                                      2.09147553258932e-09};
  // (2 artanh(s) / s - 2) / s^2 over s^2, for fractions between the roots of 1/2 and 2
  static constexpr double kLog[7] = {0.666666666666667,   0.3999999999989889, 0.28571428626253836,
                                     0.22222211089379496, 0.1818289243253687, 0.15331611722055008,
                                     0.14617807153417325};
  // (2 artanh(s) / s - 2 - 2/3 s^2) / s^4 over s^2
  static constexpr double kLogRest[8] = {0.4,
                                         0.2857142857142937,
                                         0.22222222221652765,
                                         0.18181818336099848,
                                         0.1538459488700718,
                                         0.1333480879881234,
                                         0.11706126464563398,
                                         0.11724327060846747};
  // (sin(x) / x - 1) / x^2 over x^2, |x| <= pi / 4
  static constexpr double kSin[6] = {-0.16666666666666666,    0.008333333333330936,
                                     -0.00019841269836740532, 2.7557316093198404e-06,
                                     -2.5051129896450185e-08, 1.5917988979397435e-10};
  // (cos(x) - 1 + x^2 / 2) / x^4 over x^2
  static constexpr double kCos[6] = {0.041666666666666664,  -0.0013888888888887389,
                                     2.48015872987544e-05,  -2.755731726587808e-07,
                                     2.087614504941318e-09, -1.138254464534925e-11};
  // (tanh(x) / x - 1) / x^2 over x^2, |x| <= 0.55
  static constexpr double kTanh[11] = {
      -0.3333333333333333,    0.13333333333332714,   -0.053968253967434016, 0.021869488493666944,
      -0.008863234397814355,  0.003592110378689024,  -0.001455661830100716, 0.0005889360520074057,
      -0.0002346347410887237, 8.511313685577672e-05, -2.060276537636634e-05};

  static std::uint64_t bits_of(double x) noexcept { return __builtin_bit_cast(std::uint64_t, x); }
  static double with_bits(std::uint64_t bits) noexcept { return __builtin_bit_cast(double, bits); }
  static double size(double x) noexcept { return with_bits(bits_of(x) & ~(1ULL << 63)); }
  static double rounded(double x) noexcept { return (x + kRounder) - kRounder; }
  /// 2^k of a k for which that is a normal number.
  static double two_to(int k) noexcept {
    return with_bits(static_cast<std::uint64_t>(k + 1023) << 52);
  }

  template <std::size_t kCount>
  static double polynomial(const double (&coefficient)[kCount], double x) noexcept {
    double value = coefficient[kCount - 1];
#pragma GCC unroll 16
    for (std::size_t i = kCount - 1; i > 0; --i) value = value * x + coefficient[i - 1];
    return value;
  }

  /// high + low = a + b exactly, when |a| >= |b| or a is 0.
  static Sum ordered_sum(double a, double b) noexcept {
    const double high = a + b;
    return {high, b - (high - a)};
  }
  static Sum sum(double a, double b) noexcept {
    const double high = a + b;
    const double of_b = high - a;
    return {high, (a - (high - of_b)) + (b - of_b)};
  }
  /// a * b exactly, unless a part is too large or too small.
  static Sum product(double a, double b) noexcept {
    const Sum u = halves(a);
    const Sum v = halves(b);
    const double high = a * b;
    return {high, ((u.high * v.high - high) + u.high * v.low + u.low * v.high) + u.low * v.low};
  }
  static Sum halves(double x) noexcept {
    const double large = 134217729.0 * x;  // 2^27 + 1
    const double high = large - (large - x);
    return {high, x - high};
  }

  static Scaled scaled(double x) noexcept {
    int exponent = -1023;
    if (bits_of(x) < 1ULL << 52) {
      x *= 0x1p54;
      exponent -= 54;
    }
    exponent += static_cast<int>(bits_of(x) >> 52);
    const double fraction = with_bits((bits_of(x) & ((1ULL << 52) - 1)) | 1023ULL << 52);
    if (fraction > 1.4142135623730951) return {0.5 * fraction, exponent + 1};
    return {fraction, exponent};
  }

  /// e^(x + low), where low is small.
  static double exp_of_sum(double x, double low) noexcept {
    if (!(x < 710.0)) return x == x ? kInfinity : x;
    if (x < -746.0) return 0.0;
    const double k = rounded(x * 1.4426950408889634);  // of ln 2
    const double high = x - k * kLn2High;
    const double less = k * kLn2Low - low;
    const double r = high - less;
    const double value = 1.0 + (high + (r * r * polynomial(kExp, r) - less));
    const auto exponent = static_cast<int>(k);
    const int half = exponent / 2;
    return value * two_to(half) * two_to(exponent - half);
  }

  /// log(x) to about 64 bits, for finite x > 0.
  static Sum log_of(double x) noexcept {
    const Scaled number = scaled(x);
    const double f = number.fraction - 1.0;
    const Sum divisor = ordered_sum(2.0, f);
    const double s = f / divisor.high;
    const Sum back = product(s, divisor.high);
    const double s_low = (((f - back.high) - back.low) - s * divisor.low) / divisor.high;
    Sum square = product(s, s);
    square.low += 2.0 * s * s_low;
    Sum factor = ordered_sum(2.0 / 3.0, square.high * polynomial(kLogRest, square.high));
    factor.low += kTwoThirdsLow;
    Sum part = product(square.high, factor.high);
    part.low += square.high * factor.low + square.low * factor.high;
    Sum cube = product(s, part.high);
    cube.low += s * part.low + s_low * part.high;
    Sum of_fraction = ordered_sum(2.0 * s, cube.high);
    of_fraction.low += cube.low + 2.0 * s_low;
    const double k = number.exponent;
    Sum whole = ordered_sum(k * kLn2High, of_fraction.high);
    whole.low += of_fraction.low + k * kLn2Low;
    return whole;
  }

  static Reduced reduced(double x) noexcept {
    if (size(x) > kMaxShortAngle) return reduced_by_whole_numbers(x);
    const double k = rounded(x * 0.6366197723675814);  // of pi / 2
    const Sum first = sum(x - k * kQuarter[0], -(k * kQuarter[1]));
    const Sum second = sum(first.high, -(k * kQuarter[2]));
    const Sum rest = sum(second.high, (first.low + second.low) - k * kQuarter[3]);
    return {rest, static_cast<std::uint32_t>(static_cast<int>(k))};
  }

  /// The way of Payne and Hanek. x is m 2^e with a whole m, and x 2 / pi counts in quarter turns. The digits of 2 / pi
  /// before those that are kept make whole turns; those behind are too small by 2^-137 of a quarter turn.
  static Reduced reduced_by_whole_numbers(double x) noexcept {
    const auto exponent = static_cast<int>(bits_of(x) >> 52 & 2047U);
    const std::uint64_t m = (bits_of(x) & ((1ULL << 52) - 1)) | 1ULL << 52;
    const int bit = exponent - 1075 + 62;
    const auto place = static_cast<std::size_t>(bit);
    const std::uint64_t* const first = kPerQuarter + place / 64;
    const std::size_t shift = place % 64;
    Digits digits{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t word =
          shift == 0 ? first[i] : first[i] << shift | first[i + 1] >> (64 - shift);
      digits.of_32_bits[2 * i] = word >> 32;
      digits.of_32_bits[2 * i + 1] = word & kLowHalf;
    }
    digits = times(digits, m >> 32, m & kLowHalf);
    auto quarters = static_cast<std::uint32_t>(digits.of_32_bits[0] >> 30);
    const bool is_above_half = (digits.of_32_bits[0] >> 29 & 1U) != 0;
    if (is_above_half) ++quarters;
    const Sum part = fraction_of(digits, is_above_half);
    Sum rest = product(part.high, kQuarterHigh);
    rest.low += part.low * kQuarterHigh + part.high * kQuarterLow;
    rest = ordered_sum(rest.high, rest.low);
    const bool is_negative = (bits_of(x) >> 63) != 0;
    if (is_negative) quarters = 0U - quarters;
    return {is_negative != is_above_half ? Sum{-rest.high, -rest.low} : rest, quarters};
  }

  /// A number times m = high 2^32 + low, without what is 2^192 and more.
  static Digits times(const Digits& number, std::uint64_t high, std::uint64_t low) noexcept {
    Digits product{};
    std::uint64_t carry = 0;
    std::uint64_t before = 0;  // the digit to the right
    for (std::size_t i = 6; i-- > 0;) {
      const std::uint64_t of_low = number.of_32_bits[i] * low;
      const std::uint64_t of_high = before * high;  // high has 21 bits
      const std::uint64_t sum = (of_low & kLowHalf) + (of_high & kLowHalf) + carry;
      product.of_32_bits[i] = sum & kLowHalf;
      carry = (sum >> 32) + (of_low >> 32) + (of_high >> 32);
      before = number.of_32_bits[i];
    }
    return product;
  }

  /// The size of a fraction of 190 bits below two others; less 1 where it is above a half.
  static Sum fraction_of(Digits digits, bool is_above_half) noexcept {
    Sum fraction{0.0, 0.0};
    double unit = 0x1p-30;
    digits.of_32_bits[0] &= (1U << 30) - 1;
    if (is_above_half) {  // 2^190 less it
      std::uint64_t carry = 1;
      for (std::size_t i = 6; i-- > 0;) {
        const std::uint64_t sum = (~digits.of_32_bits[i] & kLowHalf) + carry;
        digits.of_32_bits[i] = sum & kLowHalf;
        carry = sum >> 32;
      }
      digits.of_32_bits[0] &= (1U << 30) - 1;
    }
    for (const std::uint64_t digit : digits.of_32_bits) {
      const Sum sum = ordered_sum(fraction.high, static_cast<double>(digit) * unit);
      fraction = {sum.high, fraction.low + sum.low};
      unit *= 0x1p-32;
    }
    return fraction;
  }

  /// Sine of an angle and of a number of quarter turns more.
  static double sin_of_quarter(const Reduced& angle, std::uint32_t more) noexcept {
    const std::uint32_t quarters = angle.quarters + more;
    const auto [x, low] = angle.rest;
    const double z = x * x;
    double value = 0.0;
    if ((quarters & 1U) == 0) {
      value = x + (x * (z * polynomial(kSin, z)) + low * (1.0 - 0.5 * z));
    } else {
      const double half_square = 0.5 * z;
      const double most = 1.0 - half_square;
      value = most + (((1.0 - most) - half_square) + (z * z * polynomial(kCos, z) - x * low));
    }
    return (quarters & 2U) != 0 ? -value : value;
  }
};

}  // namespace cordis::engine
