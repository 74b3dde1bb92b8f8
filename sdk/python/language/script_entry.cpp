// Policies in files of Python: starts the interpreter in this process, once, and asks the module karst for
// the policies of a file. All the rest is in the module.
#include <Python.h>
#include <dlfcn.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "sdk/abi/karst_abi_script.h"

namespace {

namespace fs = std::filesystem;

/// Where this file lies: PREFIX/lib/karst/languages.
fs::path own_folder() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&own_folder), &info) != 0
             ? fs::path(info.dli_fname).parent_path()
             : fs::path();
}

/// The same numbers on every processor and under any load: numpy and BLAS choose their kernels by what the
/// processor has, and sum in another order with each number of threads.
void make_arithmetic_repeatable() {
  for (const char* threads : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"})
    setenv(threads, "1", 1);
  setenv("OPENBLAS_CORETYPE", "Prescott", 1);
  setenv("NPY_DISABLE_CPU_FEATURES",
         "SSSE3 SSE41 POPCNT SSE42 AVX F16C FMA3 AVX2 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL "
         "AVX512_ICL",
         1);
}

std::string text_of(PyObject* object) {
  const char* text = object == nullptr ? nullptr : PyUnicode_AsUTF8(object);
  if (text == nullptr) PyErr_Clear();
  return text == nullptr ? "" : text;
}

/// What the present exception of Python says, in one line. Clears it.
std::string exception_text() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  PyObject* const text = value == nullptr ? nullptr : PyObject_Str(value);
  // karst.Error says all in its text.
  const std::string kind = type == nullptr ? "" : reinterpret_cast<PyTypeObject*>(type)->tp_name;
  std::string out = kind == "Error" ? text_of(text) : kind + ": " + text_of(text);
  Py_XDECREF(text), Py_XDECREF(type), Py_XDECREF(value), Py_XDECREF(trace);
  return out;
}

/// "" or why Python cannot be started.
std::string start_python() {
  // Extension modules such as numpy's do not link libpython: its symbols must be there for all.
  dlopen(KARST_LIBPYTHON, RTLD_NOW | RTLD_GLOBAL);
  make_arithmetic_repeatable();
  PyPreConfig before;
  PyPreConfig_InitIsolatedConfig(&before);
  before.utf8_mode =
      1;  // names and contents of files and what is printed: without a locale it would be ASCII
  if (const PyStatus status = Py_PreInitialize(&before); PyStatus_Exception(status))
    return std::string("Python cannot be started: ") + (status.err_msg == nullptr ? "" : status.err_msg);
  PyConfig config;
  PyConfig_InitIsolatedConfig(&config);  // no signal handlers, no locale, no environment of the user's
  config.use_hash_seed = 1;              // sets of strings have the same order each time
  config.hash_seed = 0;
  config.write_bytecode = 0;
  config.buffered_stdio = 0;  // what a policy prints before a crash must not be lost
  const PyStatus program = PyConfig_SetBytesString(&config, &config.executable, KARST_PYTHON);
  const PyStatus status = PyStatus_Exception(program) ? program : Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  if (PyStatus_Exception(status))
    return std::string("Python cannot be started: ") + (status.err_msg == nullptr ? "" : status.err_msg);
  const std::string module = (own_folder().parent_path() / "python").string();
  PyObject* const path = PySys_GetObject("path");
  PyObject* const folder = PyUnicode_FromString(module.c_str());
  if (path == nullptr || folder == nullptr || PyList_Insert(path, 0, folder) != 0) return exception_text();
  Py_DECREF(folder);
  // numpy warns of features in the list above that the processor or this numpy does not know.
  if (PyRun_SimpleString("import warnings\n"
                         "with warnings.catch_warnings():\n"
                         "    warnings.simplefilter('ignore')\n"
                         "    import numpy\n") != 0) {
    PyEval_SaveThread();
    return "numpy cannot be imported: install python3-numpy";
  }
  // Python's module signal takes Ctrl-C over when it is first imported, by whatever module.
  struct sigaction interrupt {};
  sigaction(SIGINT, nullptr, &interrupt);
  Py_XDECREF(PyImport_ImportModule("signal"));
  sigaction(SIGINT, &interrupt, nullptr);
  PyEval_SaveThread();  // each call takes the lock for itself
  return "";
}

const karst_plugin_t* plugin_of(const std::string& file, std::string& fault) {
  PyObject* const module = PyImport_ImportModule("karst._script");
  PyObject* const capsule = module == nullptr ? nullptr
                                              : PyObject_CallMethod(module, "plugin_of_file", "N",
                                                                    PyUnicode_DecodeFSDefault(file.c_str()));
  const void* plugin = capsule == nullptr ? nullptr : PyCapsule_GetPointer(capsule, "karst_plugin_t");
  if (plugin == nullptr) fault = exception_text();
  Py_XDECREF(capsule), Py_XDECREF(module);
  return static_cast<const karst_plugin_t*>(plugin);
}

void fill(karst_error_t* error, const std::string& text) {
  if (error == nullptr) return;
  error->code = KARST_ERROR_FAILED;
  std::size_t n = std::min(text.size(), std::size_t{KARST_ERROR_TEXT_SIZE - 1});
  while (n < text.size() && n > 0 && (static_cast<unsigned char>(text[n]) & 0xC0) == 0x80) --n;
  std::memcpy(error->text, text.data(), n);
  error->text[n] = '\0';
}

}  // namespace

extern "C" KARST_EXPORT const karst_plugin_t* karst_script_entry(karst_text_t file,
                                                                 karst_error_t* error) KARST_NOEXCEPT {
  try {
    static std::mutex starting;
    static bool tried = false;
    static std::string& failure = *new std::string;
    const std::lock_guard lock(starting);
    if (!std::exchange(tried, true)) failure = start_python();
    if (!failure.empty()) return fill(error, failure), nullptr;
    const PyGILState_STATE locked = PyGILState_Ensure();
    std::string fault;
    const karst_plugin_t* const plugin = plugin_of(std::string(file.data, file.length), fault);
    PyGILState_Release(locked);
    if (plugin == nullptr) fill(error, fault);
    return plugin;
  } catch (const std::exception& e) {
    fill(error, e.what());
    return nullptr;
  }
}
