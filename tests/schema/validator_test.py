"""The schemas, in the eyes of a validator of JSON Schema, take what ships and refuse what readers refuse.

usage: validator_test.py SCHEMA_TEST FOLDER_OF_SCHEMAS
"""
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
with tempfile.TemporaryDirectory() as scratch:
    file = os.path.join(scratch, "cases.json")
    subprocess.run([program, "--gtest_filter=Schema.Refuses*", "--gtest_brief=1"], check=True,
                   env={**os.environ, "CORDIS_SCHEMA_CASES": file})
    with open(file, encoding="utf-8") as stream:
        cases = json.load(stream)

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


failures = 0
for case in cases:
    errors = list(validators[case["sort"]].iter_errors(case["document"]))
    if case["part"]:
        errors = [error for error in errors if not lacks_of_a_part(error)]
    key = case["refused"]
    if not key and errors:
        failures += 1
        print(f"{case['name']}: refused")
        for error in flat(errors):
            print("   ", list(error.absolute_path), error.message[:200])
    if key and not any(is_about(key, error) for error in flat(errors)):
        failures += 1
        print(f"{case['name']}: the key '{key}' is taken")
        for error in flat(errors):
            print("   ", list(error.absolute_path), error.message[:200])
print(f"{len(cases)} documents, {failures} failures")
sys.exit(1 if failures or len(cases) < 400 else 0)
