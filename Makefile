# make demo    install, and play examples/tour.ms on the demo library into tour.bvh
# make test    all tests;  make random: twenty times as many examples of each random one
# make edits   the language server after 10,000 random edits;  make soak: its memory after 100,000
# make lint    style and who may import whom;  make types: mypy;  make bench: measurements beside peers
# make pictures  the pictures of the README, the icon;  make recording: the session in it;  make grammars: what editors and the docs have of the grammar
# make vsix    the extension for VS Code;  make test-vscode: tries it in a real one;  make screenshot: the picture of it

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo test random edits soak lint types bench pictures recording grammars vsix wheel clean

demo: $(VENV)/installed
	$(BIN)/mlmgc examples/tour.ms -o tour.bvh --report tour.json
	@echo "look at it: $(BIN)/mlmg view tour.bvh"

test: $(VENV)/test-tools
	$(BIN)/pytest -n auto --dist worksteal

# Of what is tried with random examples, many; a quarter of an hour of a core.
random: $(VENV)/test-tools
	$(BIN)/pytest -n auto --dist worksteal -m hypothesis --hypothesis-profile many

# After each edit, what the language server says is compared with what a fresh one says; a quarter of an hour of a core.
edits: $(VENV)/test-tools
	$(BIN)/pytest -n auto tests/lsp/test_random_edits.py tests/lsp/test_features.py -k after_any_edits --edits 10000

# Whether the memory of the language server grows over 100,000 edits; about an hour of a core.
soak: $(VENV)/bench-tools
	$(BIN)/python benchmarks/soak_lsp.py

lint: $(VENV)/lint-tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

types: $(VENV)/lint-tools
	$(BIN)/mypy

bench: $(VENV)/bench-tools
	for bench in benchmarks/bench_*.py; do $(BIN)/python $$bench || exit 1; done

pictures: $(VENV)/test-tools demo
	mkdir -p dist
	$(BIN)/mlmg view tour.bvh --report tour.json -o docs/tour.png
	$(BIN)/mlmg view tour.bvh --report tour.json -o dist/walking.png --frames 250
	$(BIN)/python docs/recording/icon.py dist/walking.png lsp/editors/vscode/icon.png

# A session of `mlmg repl`, as a terminal showed it.
recording: $(VENV)/installed
	$(BIN)/pip install --quiet --editable ".[recording]"
	$(BIN)/python docs/recording/record.py docs/session.svg

grammars: $(VENV)/installed
	$(BIN)/python -m mlmg_grammar.generate --docs docs

# The extension for VS Code, with the wheel that it can install; needs node 20 or newer and npm.
vsix: $(VENV)/installed
	mkdir -p dist
	rm -rf lsp/editors/vscode/wheel
	$(BIN)/pip wheel --quiet --no-deps --wheel-dir lsp/editors/vscode/wheel .
	cd lsp/editors/vscode && npm install --no-package-lock && npm test && npm run vsix
	@echo "install it: code --install-extension dist/motion-script.vsix"

# Both need code-server and Chromium as well: see "VS Code" in docs/editors.md.
test-vscode: vsix
	cd lsp/editors/vscode && npm run test:vscode

screenshot: vsix
	node docs/recording/vscode.mjs docs/vscode.png

# The wheel, built and tested as it is installed, not the source tree.
wheel: $(VENV)/test-tools
	rm -rf dist $(VENV)-wheel
	$(BIN)/python -m build --wheel --outdir dist
	$(PYTHON) -m venv $(VENV)-wheel
	$(VENV)-wheel/bin/pip install --quiet "$$(ls dist/*.whl)[test]"
	MLMG_TEST_INSTALLED=1 $(VENV)-wheel/bin/pytest -n auto --dist worksteal

clean:
	rm -rf $(VENV) $(VENV)-wheel dist tour.bvh tour.json

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/installed: $(BIN)/python pyproject.toml
	$(BIN)/pip install --quiet --editable .
	touch $@

$(VENV)/test-tools: $(VENV)/installed
	$(BIN)/pip install --quiet --editable ".[test]"
	touch $@

$(VENV)/lint-tools: $(VENV)/installed
	$(BIN)/pip install --quiet --editable ".[test,lint]"
	touch $@

$(VENV)/bench-tools: $(VENV)/installed
	$(BIN)/pip install --quiet --editable ".[test,bench]"
	touch $@
