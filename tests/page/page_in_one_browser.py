"""What the page shows of made-up states: each script runs its checks, all in one browser."""

import importlib

for name in ("page_states", "page_small", "page_texts", "page_keys", "page_day", "page_language"):
    print(f"{name}.py", flush=True)
    importlib.import_module(name)
