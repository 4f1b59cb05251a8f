//! Puts a switch at every place of some Rust files where one token may be wrong, so that one build holds all mutants.
//!
//! Another comparison, `+` for `-`, `*` for `/`, `&&` for `||`, `&` or `^` for `|`, `<<` for `>>`, `min` for `max`, `any` for `all`,
//! a half, a double, a limit, a sign or an absolute value left out, a condition or a truth value turned round, a statement left out.
//! Constants, patterns and tests are left alone, and macros but those that make items of their file.

use crate::expand::expand;
use quote::{ToTokens, quote};
use std::collections::HashSet;
use std::{env, fs};
use syn::spanned::Spanned;
use syn::visit_mut::{self, VisitMut};
use syn::{BinOp, Expr, Stmt, UnOp, parse_quote};

struct Mutator {
    file: String,
    /// Type and function.
    of: String,
    within: String,
    next: u32,
    skip: HashSet<u32>,
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.to_token_stream().to_string().contains("test"))
}

/// Whether a condition holds a `let`, which cannot be moved.
fn has_let(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        Expr::Paren(inner) => has_let(&inner.expr),
        _ => false,
    }
}

fn others(op: &BinOp) -> Vec<BinOp> {
    match op {
        BinOp::Lt(_) => vec![parse_quote!(<=), parse_quote!(>)],
        BinOp::Le(_) => vec![parse_quote!(<), parse_quote!(>)],
        BinOp::Gt(_) => vec![parse_quote!(>=), parse_quote!(<)],
        BinOp::Ge(_) => vec![parse_quote!(>), parse_quote!(<)],
        BinOp::Eq(_) => vec![parse_quote!(!=)],
        BinOp::Ne(_) => vec![parse_quote!(==)],
        BinOp::And(_) => vec![parse_quote!(||)],
        BinOp::Or(_) => vec![parse_quote!(&&)],
        BinOp::BitAnd(_) => vec![parse_quote!(|)],
        BinOp::BitOr(_) => vec![parse_quote!(&)],
        BinOp::Add(_) => vec![parse_quote!(-)],
        BinOp::Sub(_) => vec![parse_quote!(+)],
        BinOp::Mul(_) => vec![parse_quote!(/)],
        BinOp::Div(_) => vec![parse_quote!(*)],
        BinOp::Shl(_) => vec![parse_quote!(>>)],
        BinOp::Shr(_) => vec![parse_quote!(<<)],
        BinOp::BitXor(_) => vec![parse_quote!(|)],
        BinOp::AddAssign(_) => vec![parse_quote!(-=)],
        BinOp::SubAssign(_) => vec![parse_quote!(+=)],
        _ => Vec::new(),
    }
}

/// What may be meant instead of a call: another method, or none.
fn other_call(call: &syn::ExprMethodCall) -> Option<(&'static str, Expr)> {
    let other = |name: &str| {
        let method = syn::Ident::new(name, call.method.span());
        Expr::MethodCall(syn::ExprMethodCall { method, ..call.clone() })
    };
    let receiver = || (*call.receiver).clone();
    match (call.method.to_string().as_str(), call.args.len()) {
        ("half", 0) => Some(("without half", receiver())),
        ("double", 0) => Some(("without double", receiver())),
        ("abs", 0) => Some(("without abs", receiver())),
        ("widen", 2) => Some(("without widen", receiver())),
        ("limited", 0) => Some(("without limited", receiver())),
        ("clamp", 2) => Some(("without clamp", receiver())),
        ("magnitude", 0) => Some(("without magnitude", receiver())),
        ("minus", 0) => Some(("without minus", receiver())),
        ("wrapping_neg", 0) => Some(("without wrapping_neg", receiver())),
        ("next_up", 0) => Some(("without next_up", receiver())),
        ("copysign", 1) => Some(("without copysign", receiver())),
        ("negate_if", 1) => Some(("without negate_if", receiver())),
        ("wrapping_add", 1) => Some(("wrapping_sub for wrapping_add", other("wrapping_sub"))),
        ("wrapping_sub", 1) => Some(("wrapping_add for wrapping_sub", other("wrapping_add"))),
        ("min", 1) => Some(("max for min", other("max"))),
        ("max", 1) => Some(("min for max", other("min"))),
        ("any", 1) => Some(("all for any", other("all"))),
        ("all", 1) => Some(("any for all", other("any"))),
        ("is_some", 0) => Some(("is_none for is_some", other("is_none"))),
        ("is_none", 0) => Some(("is_some for is_none", other("is_some"))),
        _ => None,
    }
}

impl Mutator {
    /// The number of a mutant, if it is not to be skipped.
    fn number(&mut self, at: proc_macro2::Span, what: &str) -> Option<u32> {
        self.next += 1;
        if self.skip.contains(&self.next) {
            return None;
        }
        println!("{}\t{}:{}\t{what} in {}{}", self.next, self.file, at.start().line, self.of, self.within);
        Some(self.next)
    }

    /// The mutant of an expression, or what became of it by those inside.
    fn or(&mut self, at: proc_macro2::Span, what: &str, mutant: Expr, own: Expr) -> Expr {
        match self.number(at, what) {
            // In parentheses: what begins with `if` would be a statement there, and what follows its block another one.
            Some(n) => parse_quote!((if crate::mutant_switch::on(#n) { (#mutant) } else { (#own) })),
            None => own,
        }
    }
}

impl VisitMut for Mutator {
    fn visit_item_mod_mut(&mut self, item: &mut syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit_mut::visit_item_mod_mut(self, item);
        }
    }

    fn visit_item_const_mut(&mut self, _: &mut syn::ItemConst) {}

    fn visit_item_static_mut(&mut self, _: &mut syn::ItemStatic) {}

    fn visit_impl_item_const_mut(&mut self, _: &mut syn::ImplItemConst) {}

    fn visit_trait_item_const_mut(&mut self, _: &mut syn::TraitItemConst) {}

    fn visit_expr_const_mut(&mut self, _: &mut syn::ExprConst) {}

    fn visit_item_fn_mut(&mut self, item: &mut syn::ItemFn) {
        if item.sig.constness.is_none() && !is_test(&item.attrs) {
            self.within = item.sig.ident.to_string();
            visit_mut::visit_item_fn_mut(self, item);
        }
    }

    fn visit_impl_item_fn_mut(&mut self, item: &mut syn::ImplItemFn) {
        if item.sig.constness.is_none() {
            self.within = item.sig.ident.to_string();
            visit_mut::visit_impl_item_fn_mut(self, item);
        }
    }

    fn visit_trait_item_fn_mut(&mut self, item: &mut syn::TraitItemFn) {
        self.within = item.sig.ident.to_string();
        visit_mut::visit_trait_item_fn_mut(self, item);
    }

    fn visit_item_impl_mut(&mut self, item: &mut syn::ItemImpl) {
        // Names and orders for messages and heaps aside, what formats is not of interest.
        let of_display =
            item.trait_.as_ref().is_some_and(|(_, path, _)| path.to_token_stream().to_string().contains("Display"));
        if !of_display {
            self.of = format!("{}::", item.self_ty.to_token_stream().to_string().replace(' ', ""));
            visit_mut::visit_item_impl_mut(self, item);
            self.of.clear();
        }
    }

    fn visit_pat_mut(&mut self, _: &mut syn::Pat) {}

    fn visit_type_mut(&mut self, _: &mut syn::Type) {}

    fn visit_expr_repeat_mut(&mut self, repeat: &mut syn::ExprRepeat) {
        self.visit_expr_mut(&mut repeat.expr);
    }

    fn visit_arm_mut(&mut self, arm: &mut syn::Arm) {
        if let Some((_, guard)) = &mut arm.guard {
            self.visit_expr_mut(guard);
        }
        self.visit_expr_mut(&mut arm.body);
    }

    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        let (before, at) = (expr.clone(), expr.span());
        visit_mut::visit_expr_mut(self, expr);
        match before {
            Expr::Binary(binary) if !has_let(&Expr::Binary(binary.clone())) => {
                for op in others(&binary.op) {
                    let what = format!("{} for {}", op.to_token_stream(), binary.op.to_token_stream());
                    let mutant = Expr::Binary(syn::ExprBinary { op, ..binary.clone() });
                    *expr = self.or(at, &what, mutant, expr.clone());
                }
            }
            Expr::MethodCall(call) => {
                if let Some((what, mutant)) = other_call(&call) {
                    *expr = self.or(at, what, mutant, expr.clone());
                }
            }
            Expr::Unary(syn::ExprUnary { op: UnOp::Not(_) | UnOp::Neg(_), expr: inner, .. }) => {
                *expr = self.or(at, "without ! or -", *inner, expr.clone());
            }
            Expr::Lit(syn::ExprLit { lit: syn::Lit::Bool(value), .. }) => {
                let other = syn::LitBool::new(!value.value, at);
                *expr = self.or(at, "the other truth value", parse_quote!(#other), expr.clone());
            }
            Expr::If(condition) if !has_let(&condition.cond) => {
                if let (Expr::If(own), Some(n)) =
                    (&mut *expr, self.number(condition.cond.span(), "the condition turned round"))
                {
                    let cond = own.cond.clone();
                    own.cond = parse_quote!((crate::mutant_switch::on(#n) != (#cond)));
                }
            }
            _ => {}
        }
    }

    fn visit_stmt_mut(&mut self, stmt: &mut Stmt) {
        let at = stmt.span();
        visit_mut::visit_stmt_mut(self, stmt);
        let is_call = matches!(stmt, Stmt::Expr(Expr::MethodCall(_) | Expr::Assign(_), Some(_)))
            || matches!(stmt, Stmt::Expr(Expr::Try(_), Some(_)));
        if is_call && let Some(n) = self.number(at, "the statement left out") {
            let own = stmt.clone();
            *stmt = parse_quote!(if !crate::mutant_switch::on(#n) { #own });
        }
    }
}

/// Rewrites the files in place and prints a line a mutant; numbers begin after `after`.
pub fn put(after: u32, root: &str, files: &[String]) {
    let skip = env::var("SKIP").unwrap_or_default();
    let skip = skip.split_whitespace().filter_map(|number| number.parse().ok()).collect();
    let mut mutator = Mutator { file: String::new(), of: String::new(), within: String::new(), next: after, skip };
    for file in files {
        let text = fs::read_to_string(file).expect("a file");
        let mut parsed = syn::parse_file(&text).expect("Rust");
        expand(&mut parsed);
        // Two crates have files of one name.
        let (package, name) = file.rsplit_once("/src/").unwrap_or_default();
        let package = match package {
            "pcr-fixed" => "pcr-fixed/",
            "pcr-host/exclusions" => "exclusions/",
            "pcr-host/serve" => "serve/",
            _ => "",
        };
        mutator.file = format!("{package}{name}");
        mutator.visit_file_mut(&mut parsed);
        fs::write(file, prettyplease::unparse(&parsed)).expect("written");
    }
    let last = mutator.next as usize;
    let switch = quote! {
        #[doc(hidden)]
        #[allow(missing_docs)]
        pub mod mutant_switch {
            extern crate std;
            use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
            use std::io::Write;

            const UNKNOWN: u32 = u32::MAX;
            const WRITES: u32 = u32::MAX - 1;
            static ON: AtomicU32 = AtomicU32::new(UNKNOWN);
            static SEEN: [AtomicBool; #last + 1] = [const { AtomicBool::new(false) }; #last + 1];

            /// Whether the mutant of this number is on.
            #[inline]
            pub fn on(number: u32) -> bool {
                match ON.load(Ordering::Relaxed) {
                    UNKNOWN => read(number),
                    WRITES => write(number),
                    chosen => chosen == number,
                }
            }

            #[cold]
            #[inline(never)]
            fn read(number: u32) -> bool {
                let chosen = match std::env::var("REACHED") {
                    Ok(_) => WRITES,
                    Err(_) => std::env::var("MUTANT").ok().and_then(|number| number.parse().ok()).unwrap_or(0),
                };
                ON.store(chosen, Ordering::Relaxed);
                on(number)
            }

            /// Writes which ones are asked for.
            #[cold]
            #[inline(never)]
            fn write(number: u32) -> bool {
                let seen = &SEEN[number as usize];
                if !seen.load(Ordering::Relaxed) && !seen.swap(true, Ordering::Relaxed) {
                    let file = std::env::var("REACHED").expect("a name");
                    let mut file = std::fs::OpenOptions::new().append(true).create(true).open(file).expect("a file");
                    file.write_all(std::format!("{number}\n").as_bytes()).expect("written");
                }
                false
            }
        }
    };
    let text = fs::read_to_string(root).expect("the root");
    fs::write(root, format!("{text}\n{switch}\n")).expect("written");
}
