# Targets a user types. `cargo` is all they need.

.PHONY: all font test check bench fuzz clean

all: font

font: ## the demo fonts, into build/
	cargo build --release --locked --quiet
	for p in glyphs/*.toml; do cargo run --release --locked --quiet -- build "$$p" || exit 1; done

test: ## every test
	cargo test --locked --quiet

check: ## the gate: format, lints, tests, docs
	.githooks/pre-push

bench: ## the papers' tables on the silhouettes of the folder SHAPES
	cargo bench --locked --quiet --bench papers -- $(SHAPES)

fuzz: ## broken inputs at every door, 10 seconds each; `cargo fuzz` goes deeper, see fuzz/README.md
	cargo run --release --quiet --manifest-path fuzz/Cargo.toml -- --seconds 10

clean: ## what was built
	cargo clean --quiet
	rm -rf build fuzz/target
