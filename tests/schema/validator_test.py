"""The schemas, in the eyes of a validator of JSON Schema, take what readers take and refuse what they refuse.

usage: validator_test.py SCHEMA_TEST FOLDER_OF_SCHEMAS
"""
import glob
import json
import os
import subprocess
import sys
import tempfile

try:
    from jsonschema import Draft7Validator
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)  # skipped

program, folder = sys.argv[1:]
cases = []
with tempfile.TemporaryDirectory() as scratch:
    subprocess.run([program, "--gtest_filter=Schema.Refuses*:Schema.Takes*:Values.*", "--gtest_brief=1"],
                   check=True, env={**os.environ, "CORDIS_SCHEMA_CASES": scratch})
    for file in sorted(glob.glob(os.path.join(scratch, "*.json"))):
        with open(file, encoding="utf-8") as stream:
            some = json.load(stream)
        print(f"{os.path.basename(file)}: {len(some)} documents")
        cases += some

validators = {}
for sort in ("scene", "launch", "device"):
    with open(os.path.join(folder, f"{sort}.schema.json"), encoding="utf-8") as stream:
        schema = json.load(stream)
    Draft7Validator.check_schema(schema)
    validators[sort] = Draft7Validator(schema)


def flat(errors):
    """All errors, those within others too."""
    for error in errors:
        yield error
        yield from flat(error.context)


def lacks_of_a_part(error):
    """True if an error says that a part of a file is no whole file."""
    return error.validator == "required" and not error.absolute_path


def is_about(key, error):
    """True if an error refuses a key, or misses another one beside it."""
    if error.validator == "required":
        return key in error.instance
    return error.validator in ("additionalProperties", "propertyNames", "enum") and f"'{key}'" in error.message


def fault_of(case):
    """What a validator says wrongly of a case, and its errors."""
    validator = validators[case["sort"]]
    if case.get("refused") == "" and validator.is_valid(case["document"]):
        return "", []
    errors = list(validator.iter_errors(case["document"]))
    if "path" in case:
        path = case["path"]
        there = [error for error in flat(errors) if list(error.absolute_path)[:len(path)] == path]
        if case["taken"] and there:
            return f"{path} is refused", there
        return ("", []) if case["taken"] or there else (f"{path} is taken", errors)
    if case["part"]:
        errors = [error for error in errors if not lacks_of_a_part(error)]
    key = case["refused"]
    if not key:
        return ("refused" if errors else ""), errors
    return ("" if any(is_about(key, error) for error in flat(errors)) else f"the key '{key}' is taken"), errors


failures = 0
for case in cases:
    fault, errors = fault_of(case)
    if not fault:
        continue
    failures += 1
    print(f"{case['name']}: {fault}")
    for error in list(flat(errors))[:20]:
        print("   ", list(error.absolute_path), error.message[:200])
print(f"{len(cases)} documents, {failures} failures")
sys.exit(1 if failures or len(cases) < 400 else 0)
