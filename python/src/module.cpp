// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// caplet._caplet: the library's public classes for the package's Python, which is what programs
// use.
#include <caplet/device.h>
#include <caplet/log.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <typeinfo>

#include "binding.h"

namespace caplet_python {

namespace {

/// Raises caplet.errors.NAME(messages).
void raise(const char* name, const std::vector<std::string>& messages) {
  nb::list list;
  for (const std::string& message : messages)
    list.append(nb::steal<nb::str>(
        PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "replace")));
  const nb::object type = nb::module_::import_("caplet.errors").attr(name);
  const nb::object error = type(list);
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

void bind_errors(nb::module_& m) {
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void*) {
        try {
          std::rethrow_exception(thrown);
        } catch (const caplet::InputError& error) {
          raise("InputError", error.messages());
        } catch (const caplet::RunError& error) {
          if (PyErr_CheckSignals() != 0)
            return;  // the kernels' compiler fails where it hears a signal: that is the reason then
          raise("RunError", {error.what()});
        } catch (const std::bad_cast&) {  // of nb::cast: a text with half a surrogate, a number
                                          // that has no place
          PyErr_SetString(PyExc_TypeError,
                          "an argument is of a type, or has a value, that is not taken here");
        }
      },
      nullptr);
  m.def("set_program", &caplet::set_program);
  m.def("set_log_level", [](const std::string& least) {
    using caplet::LogLevel;
    caplet::set_log_level(least == "info"    ? LogLevel::info
                          : least == "error" ? LogLevel::error
                          : least == "none"  ? LogLevel::none
                                             : LogLevel::warning);
  });
}

}  // namespace caplet_python

NB_MODULE(_caplet, m) {
  caplet_python::bind_threads(m);
  caplet_python::bind_errors(m);
  caplet_python::bind_scene(m);
  caplet_python::bind_render(m);
  caplet_python::bind_trace(m);
  caplet_python::bind_batch(m);
}
