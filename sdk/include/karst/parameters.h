// Parameters: one table lists every tunable field of a policy with unit, range and a line of help.
// Defaults are the fields' own values, so they are written once.
#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <type_traits>
#include <vector>

#include <karst/types.h>

namespace karst {

class Parameters {
 public:
  void add(std::string id, double& field, std::string unit, double low, double high, std::string help) {
    rows_.push_back({KARST_PARAMETER_REAL, &field, std::move(id), std::move(unit), std::move(help), "", "",
                     field, low, high});
  }
  void add(std::string id, int& field, int low, int high, std::string help) {
    rows_.push_back({KARST_PARAMETER_INTEGER, &field, std::move(id), "", std::move(help), "", "",
                     static_cast<double>(field), static_cast<double>(low), static_cast<double>(high)});
  }
  void add(std::string id, bool& field, std::string help) {
    rows_.push_back({KARST_PARAMETER_BOOLEAN, &field, std::move(id), "", std::move(help), "", "",
                     field ? 1.0 : 0.0, 0, 1});
  }
  /// `choices`: the allowed texts, separated by '|'; empty if any text is allowed.
  void add(std::string id, std::string& field, std::string choices, std::string help) {
    rows_.push_back({KARST_PARAMETER_TEXT, &field, std::move(id), "", std::move(help), std::move(choices),
                     field, 0, 0, 0});
  }

  /// The declarations, as views of this table.
  std::vector<karst_parameter_t> declarations() const {
    std::vector<karst_parameter_t> out;
    for (const Row& r : rows_)
      out.push_back({to_abi(r.id), to_abi(r.unit), to_abi(r.help), to_abi(r.choices), to_abi(r.default_text),
                     r.default_number, r.low, r.high, r.type, 0});
    return out;
  }

  /// Writes the host's values into the fields. Throws Error on a value this table does not declare.
  void assign(const karst_parameter_value_t* values, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      Row* row = find(from_abi(values[i].id));
      if (row == nullptr || row->type != values[i].type)
        throw Error("the host passed a parameter never declared: " + from_abi(values[i].id),
                    KARST_ERROR_ARGUMENT);
      row->assign(values[i]);
    }
  }

 private:
  struct Row {
    karst_parameter_type_t type;
    void* field;
    std::string id, unit, help, choices, default_text;
    double default_number, low, high;

    void assign(const karst_parameter_value_t& v) const {
      switch (type) {
        case KARST_PARAMETER_REAL:
          *static_cast<double*>(field) = v.number;
          break;
        case KARST_PARAMETER_INTEGER:
          *static_cast<int*>(field) = static_cast<int>(v.number);
          break;
        case KARST_PARAMETER_BOOLEAN:
          *static_cast<bool*>(field) = v.number != 0.0;
          break;
        default:
          *static_cast<std::string*>(field) = from_abi(v.text);
      }
    }
  };
  Row* find(const std::string& id) {
    for (Row& r : rows_)
      if (r.id == id) return &r;
    return nullptr;
  }

  std::deque<Row> rows_;  // a deque: views of its strings stay valid while it grows
};

}  // namespace karst
