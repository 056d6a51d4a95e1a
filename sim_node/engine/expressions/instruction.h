// sim_node/engine/expressions/instruction.h -- the words an expression over a link is made of.
//
// Includes nothing but cstdint, so that the loops compiled for each vector width can include it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cordis::engine {

/// What a condition or an expression may ask of a link, from its end a to its end b, in the present
/// step. In 1 dimension the distance is signed, and elongation means towards larger values.
enum class Quantity : std::uint8_t {
  kDistance = 0,    ///< d [m]
  kElongation = 1,  ///< d - rest length [m]
  kSpeed = 2,       ///< elongation rate along its line of centres, from x(n) - x(n-1) [m/s]; true
                    ///< also in the step in which a state is entered; 0 while d is 0
  kSpeedX = 3,      ///< velocity of b relative to a along an axis [m/s]
  kSpeedY = 4,
  kSpeedZ = 5,
  kSlip = 6,   ///< length of the relative velocity across the line of centres [m/s], >= 0
  kForce = 7,  ///< tension of the link in the last step [N], positive pulls the ends together; 0 at
               ///< step 0
  kImpulse = 8,      ///< sum of tension * dt since the state was entered [N s]
  kAge = 9,          ///< time since the state was entered [s]; 0 in that step, and at step 0
  kRestLength = 10,  ///< present rest length [m]
  kMassA = 11,       ///< mass of end a [kg]; 0 for a fixed point or a port mass
  kMassB = 12,
  kSlid =
      13,  ///< stretch of the spring of its friction as the last step ended [m], >= 0; 0 without
           ///< friction
  kAngle = 14,         ///< angle of a bend [rad], in 2 dimensions within +-pi
  kBend = 15,          ///< angle beyond the rest angle [rad], in 2 dimensions within +-pi
  kAngularSpeed = 16,  ///< rate of the angle, from x(n) - x(n-1) [rad/s]
  kMoment = 17,  ///< moment in the last step [N m], positive against a positive bend; 0 at step 0
  kRestAngle = 18,  ///< present rest angle [rad]
  kNone = 19        ///< not a quantity: of a change of state that was forced from outside
};
inline constexpr std::size_t kQuantityCount = 19;
static_assert(static_cast<std::size_t>(Quantity::kNone) == kQuantityCount);

/// True for what a bend alone has; it has an age beside them, and nothing else.
constexpr bool is_of_angle(Quantity quantity) noexcept {
  return quantity >= Quantity::kAngle && quantity <= Quantity::kRestAngle;
}

/// What one instruction does with the values on top of the stack. Truth is 1 or 0; any value that
/// is not 0 counts as true. Comparisons with NaN are false, kNotEqual is true.
enum class Operation : std::uint8_t {
  kConstant,  ///< pushes Instruction::constant
  kQuantity,  ///< pushes Instruction::quantity
  kNegate,    ///< takes one value, as do kAbs, kSqrt, kNot, kRising, kFalling
  kAbs,
  kMin,  ///< takes two values, the lower on the stack on the left
  kMax,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kSqrt,
  kLess,
  kLessOrEqual,
  kGreater,
  kGreaterOrEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kNot,
  kRising,  ///< 1 when the value is greater than one step before, else 0; 0 in the first step in
            ///< which a state's exits are tested; remembers the value in Instruction::slot
  kFalling,
  kSelect,  ///< takes three values, the lowest on the stack a truth: the middle one when it is so,
            ///< else the upper one
  kSign,    ///< takes one value: -1 or 1; zero and NaN stay what they are
  kExp,     ///< takes one value, as the rest but kPower, see elementary_functions.h
  kLog,
  kSin,
  kCos,
  kTanh,
  kPower,       ///< takes two values, the lower on the stack to the power of the upper
  kWholePower,  ///< raises to the power of Instruction::constant, a whole number of at most
                ///< kMaxWholePower
  kVariable     ///< pushes the value that a Variable of the network had as the last step ended;
                ///< Instruction::slot is its number
};
inline constexpr std::size_t kOperationCount = 32;
static_assert(static_cast<std::size_t>(Operation::kVariable) + 1 == kOperationCount);

struct Instruction {
  Operation operation = Operation::kConstant;
  Quantity quantity = Quantity::kDistance;
  double constant = 0.0;   ///< value for kConstant and kWholePower
  std::uint32_t slot = 0;  ///< kRising and kFalling: where the link keeps the last value; not
                           ///< shared by two instructions of one state's exits. kVariable: its
                           ///< number
};

/// The most values a program may have on its stack.
inline constexpr std::size_t kMaxStack = 16;
/// The most slots a state machine may use: slots are numbered below it.
inline constexpr std::uint32_t kMaxSlots = 16;

}  // namespace cordis::engine
