// SPDX-License-Identifier: Apache-2.0
// The SPIR-V instructions that describe a shader's interface; numbers from the Khronos
// specification "SPIR-V 1.6", sec. 3.
#include "vulkan/reflect.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace lambent::vulkan {
namespace {

constexpr std::uint32_t kMagic = 0x07230203u;
constexpr std::size_t kHeaderWords = 5;

enum Op : std::uint32_t {
  kExecutionMode = 16,
  kTypeInt = 21,
  kTypeFloat = 22,
  kTypeVector = 23,
  kTypeMatrix = 24,
  kTypeArray = 28,
  kTypeStruct = 30,
  kTypePointer = 32,
  kConstant = 43,
  kVariable = 59,
  kDecorate = 71,
  kMemberDecorate = 72,
};
constexpr std::uint32_t kLocalSize = 17;  // execution mode
constexpr std::uint32_t kArrayStride = 6, kBinding = 33, kDescriptorSet = 34,
                        kOffset = 35;       // decorations
constexpr std::uint32_t kPushConstant = 9;  // storage class
constexpr std::uint32_t kAddressBytes = 8;

/// The parts of a type from which its size follows.
struct Type {
  Op op;
  std::vector<std::uint32_t> operands;
};

class ReflectedModule {
 public:
  explicit ReflectedModule(Spirv words) {
    if (words.size() < kHeaderWords || words[0] != kMagic) {
      throw std::runtime_error("a shader is not SPIR-V");
    }
    for (std::size_t at = kHeaderWords; at < words.size();) {
      const std::uint32_t length = words[at] >> 16, op = words[at] & 0xFFFFu;
      if (length == 0 || at + length > words.size()) {
        throw std::runtime_error("a shader's SPIR-V is cut off");
      }
      read(static_cast<Op>(op), words.subspan(at + 1, length - 1));
      at += length;
    }
  }

  Reflection result() const {
    Reflection found;
    found.group_size = group_size_;
    for (const auto& [variable, storage] : variables_) {
      const std::uint32_t pointee = types_.at(storage.type).operands[1];
      if (storage.storage_class == kPushConstant) {
        found.argument_bytes = bytes(pointee);
        // Arguments are a single struct in the block
        const Type& block = types_.at(pointee);
        const std::uint32_t first = block.operands.empty() ? pointee : block.operands[0];
        const bool wrapped = block.operands.size() == 1 && types_.at(first).op == kTypeStruct;
        const std::uint32_t arguments = wrapped ? first : pointee;
        for (std::uint32_t m = 0; m < types_.at(arguments).operands.size(); ++m) {
          found.argument_offsets.push_back(member(arguments, m, kOffset));
        }
      }
      const auto binding = decorations_.find({variable, kBinding});
      if (binding != decorations_.end()) {
        const auto set = decorations_.find({variable, kDescriptorSet});
        found.bindings.push_back({set == decorations_.end() ? 0 : set->second, binding->second});
      }
    }
    return found;
  }

 private:
  struct Variable {
    std::uint32_t type, storage_class;
  };

  void read(Op op, Spirv o) {
    switch (op) {
      case kExecutionMode:
        if (o[1] == kLocalSize) group_size_ = {o[2], o[3], o[4]};
        break;
      case kTypeInt:
      case kTypeFloat:
      case kTypeVector:
      case kTypeMatrix:
      case kTypeArray:
      case kTypeStruct:
      case kTypePointer:
        types_[o[0]] = {op, {o.begin() + 1, o.end()}};
        break;
      case kConstant:
        constants_[o[1]] = o[2];
        break;
      case kVariable:
        variables_.push_back({o[1], {o[0], o[2]}});
        break;
      case kDecorate:
        decorations_[{o[0], o[1]}] = o.size() > 2 ? o[2] : 0;
        break;
      case kMemberDecorate:
        members_[{{o[0], o[1]}, o[2]}] = o.size() > 3 ? o[3] : 0;
        break;
    }
  }

  std::uint32_t member(std::uint32_t type, std::uint32_t index, std::uint32_t decoration) const {
    const auto found = members_.find({{type, index}, decoration});
    return found == members_.end() ? 0 : found->second;
  }

  std::uint32_t bytes(std::uint32_t id) const {
    const Type& type = types_.at(id);
    constexpr std::uint32_t kBitsPerByte = 8;
    switch (type.op) {
      case kTypeInt:
      case kTypeFloat:
        return type.operands[0] / kBitsPerByte;
      case kTypeVector:
      case kTypeMatrix:
        return bytes(type.operands[0]) * type.operands[1];
      case kTypeArray: {
        const auto stride = decorations_.find({id, kArrayStride});
        const std::uint32_t each =
            stride == decorations_.end() ? bytes(type.operands[0]) : stride->second;
        return each * constants_.at(type.operands[1]);
      }
      case kTypeStruct: {
        std::uint32_t end = 0;
        for (std::uint32_t m = 0; m < type.operands.size(); ++m) {
          end = std::max(end, member(id, m, kOffset) + bytes(type.operands[m]));
        }
        return end;
      }
      default:
        return kAddressBytes;
    }
  }

  std::array<std::uint32_t, 3> group_size_ = {1, 1, 1};
  std::map<std::uint32_t, Type> types_;
  std::map<std::uint32_t, std::uint32_t> constants_;
  std::vector<std::pair<std::uint32_t, Variable>> variables_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> decorations_;
  std::map<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>, std::uint32_t>
      members_;
};

}  // namespace

Reflection reflect(Spirv spirv) {
  return ReflectedModule(spirv).result();
}

}  // namespace lambent::vulkan
